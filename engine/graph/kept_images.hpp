#pragma once

#include "graph/compiled.hpp"

#include <functional>
#include <map>

namespace catoptric::graph {

/// The images of a runner that outlive frames, by their names.
class KeptImages {
public:
    explicit KeptImages(gpu::Device& device) : device_(device) {}

    /// Finds or makes those of the shape. Calls `wait` before anything is destroyed that frames in
    /// flight may use.
    void provide(Compiled& shape, const std::function<void()>& wait);
    /// The shape's frame was submitted: what it wrote is the last frame now.
    void advance(const Compiled& shape);
    History history() const;

private:
    void make(const ImageDesc& desc, Kept& kept);

    gpu::Device& device_;
    std::map<std::string, Kept> all_;
};

} // namespace catoptric::graph
