#pragma once

#include "graph/compiled.hpp"

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace catoptric::graph {

/// What earlier frames have left for later ones, by the images' names. Taken out of a runner it can
/// be given back to it; the device must outlive it.
using RetainedImages = std::map<std::string, PersistentImage>;

/// The images of a runner that outlive frames, by their names.
class PersistentImages {
public:
    explicit PersistentImages(gpu::Device& device) : device_(device) {}

    /// Finds or makes those of the shape. Calls `wait` before anything is destroyed that frames in
    /// flight may use.
    void provide(Compiled& shape, const std::function<void()>& wait);
    /// The frame was submitted: kept images hold what it says that they are made from.
    void write(const Graph& graph, const Compiled& shape);
    /// What it wrote beside its `previous` is the last frame now.
    void advance(const Compiled& shape);
    /// All of it. Not while frames are in flight.
    void forget() { all_.clear(); }
    RetainedImages take() { return std::exchange(all_, {}); }
    void put(RetainedImages all) { all_ = std::move(all); }
    History history() const;
    /// Bytes that are taken of the device.
    std::uint64_t bytes() const;

private:
    void make(const ImageDesc& desc, PersistentImage& kept);
    PersistentImage& provide(const ImageDesc& desc, Lifetime lifetime,
                             const std::function<void()>& wait);

    gpu::Device& device_;
    RetainedImages all_;
};

} // namespace catoptric::graph
