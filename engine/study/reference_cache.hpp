#pragma once

#include "measure/halves.hpp"
#include "measure/picture_mean.hpp"
#include "session/run.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "study/compare_row.hpp"
#include "study/compare_to_target.hpp"
#include "study/reference_seeds.hpp"

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::study {

using namespace session;

/// Default reference of scenes with rough mirrors. Each of its frames traces 64 rays from the first
/// rough surface of each pixel.
inline constexpr const char* kRoughReference = "raytrace:depth=16,rays=64";
/// What the pixels of the reference picture show.
enum class ReferencePixelKind {
    centre,    ///< what one camera ray through the pixel's centre meets, as the techniques do
    converged, ///< the mean over the pixel's area, by many camera rays
    paths      ///< as `centre`, by path tracing: with light that no technique models
};
/// Reference of ReferencePixelKind::paths. Each of its rays follows at most 16 reflections.
inline constexpr const char* kPathReference = "raytrace:depth=16,rays=64,indirect=paths";
/// References of ReferencePixelKind::converged, for scenes without and with rough mirrors.
inline constexpr const char* kConvergedReference = "raytrace:depth=16,samples=256";
inline constexpr const char* kConvergedRoughReference = "raytrace:depth=16,samples=64,rays=1";
/// Returns the reference of a comparison: the one that was asked for, or the one for these pixels
/// and for this scene, which may have rough mirrors.
std::string choose_reference(const std::string& asked, const scene::Scene& scene,
                             ReferencePixelKind truth = ReferencePixelKind::centre);

/// Returns whether a reference of this scene has noise: it traces paths, or draws rays to the
/// environment or from the lobes of rough surfaces.
bool is_noisy(const std::string& reference, const scene::Scene& scene);
/// Throws `usage` for a reference without noise, which cannot be kept in a file.
void check_reference_has_file(const std::string& reference, const scene::Scene& scene,
                              const std::filesystem::path& file);

/// A noisy reference: two means of frames. All frames have different seeds.
struct NoisyReference {
    explicit NoisyReference(ReferenceSeeds free_seeds) : seeds(std::move(free_seeds)) {}

    ReferenceSeeds seeds;
    /// The frames' technique. Its rays are those of the reference, or fewer if these take long.
    std::string technique;
    std::vector<int> used; ///< seeds of all frames
    measure::PictureMean a, b;
    measure::NoisyHalves halves; ///< halves of these means, after exposure
    double seconds = 0;          ///< time in which all frames were rendered, dropped ones too
    double frame_seconds = 0;    ///< time of the last frame
};

/// Picture that a row is judged against: the reference at the row's own sample count.
struct ReferencePicture {
    TechniqueResult part; ///< of a reference with noise, the picture is the mean of its halves
    std::vector<double> gpu_ms;
    std::shared_ptr<NoisyReference> noisy; ///< null: the reference has no noise

    ComparedReference compared() const { return {part.hdr, noisy ? &noisy->halves : nullptr}; }
};

/// Returns "1" for rows without the knob `samples`.
std::string sample_count(const ParsedTechnique& choice);
/// Returns the text of the reference with `samples` set. Returns the text unchanged if it has no
/// such knob, or if it states more than one sample, because it is then the reference of all rows.
std::string set_samples(const std::string& reference, const std::string& samples);

/// Returns the most rays of a lobe for each pixel in the first frames of a noisy reference: a power
/// of two, with which a frame has at most 2^18 rays, or all rays that the reference asks for. At
/// least 1.
int choose_coarse_rays(const std::string& reference, uvec2 size);
/// Returns the reference with these rays.
std::string choose_coarse_technique(const std::string& reference, uvec2 size);
/// Returns the rays for each pixel in later frames: as many as `wanted`, or the largest power of
/// two with which two frames fit into `seconds`, for frames of `rays` rays that take
/// `frame_seconds`.
int choose_refined_rays(int wanted, int rays, double frame_seconds, double seconds);

/// The reference of a comparison, rendered once for each sample count and instant on demand. A
/// reference that draws rays from lobes has noise if the scene has a rough reflector. Such a
/// reference is kept as two halves (measure/halves.hpp), which begin with a frame each and may
/// grow. The first frames of a large picture have few rays.
class ReferenceCache {
public:
    /// All objects passed by reference must outlive the cache. `base` describes the scene that the
    /// session shows, and its techniques are the rows. `seconds`: time for all noisy references;
    /// 0: each half is one frame with the rays of the reference, whatever time it takes, so that
    /// the pictures do not depend on the speed of the machine.
    ReferenceCache(Session& session, const Request& base, const std::string& reference,
                   const Watcher& watcher, double seconds)
        : session_(session), base_(base), reference_(reference), watcher_(watcher),
          begins_coarse_(seconds > 0) {}

    /// Returns the reference of a row's last frame. Valid as long as the cache. Throws as the
    /// watcher does.
    const ReferencePicture& get(const std::string& samples) { return get(samples, base_.total()); }
    /// Returns the reference of a row's frame `number`, from 1.
    const ReferencePicture& get(const std::string& samples, int number);
    /// Returns what one ray through each pixel centre meets: first mirror | second mirror << 16.
    /// Valid as long as the cache.
    const std::vector<std::uint32_t>& hits() { return hits(base_.total()); }
    const std::vector<std::uint32_t>& hits(int number);

    bool has_noise() const;
    /// Adds frames to both halves of the reference of a row's last frame, until each half has the
    /// rays that the reference asks for, and the error between the halves over the mirrors is at
    /// most that of the target; or until further frames would take longer than `seconds` in all.
    /// If frames of more rays fit into the time, they replace those of few rays. Reports progress
    /// to the watcher. Returns whether the reference changed. Does nothing for a reference without
    /// noise, and if no pixel shows a mirror.
    bool grow(const std::string& samples, double seconds, const NoiseFloorTarget& target);
    /// Returns the error between the halves of the reference of a row's last frame, over the
    /// mirrors; NaN if no pixel shows a mirror. Only for noisy references.
    double measure_noise_floor(const std::string& samples, ErrorQuantity quantity);
    /// Returns the time in which the frames of all references with noise were rendered, seconds.
    double noisy_seconds() const;
    /// Keeps the reference of a row's last frame at one sample a pixel in a file, and begins with
    /// the content of the file if it exists. Call it before the reference is needed. Throws `usage`
    /// for a reference without noise.
    void keep_in_file(const std::filesystem::path& file);
    /// Writes the file, if the reference is kept in one.
    void write_file();
    /// Returns the noise of the reference for this sample count, over the mirrors. Only for noisy
    /// references.
    measure::ReferenceNoise measure_noise(const std::string& samples);

private:
    /// Returns the number of the frame that is rendered to get the picture of frame `number`. All
    /// frames of a still scene are equal, so the last frame is rendered for each of them.
    int frame_to_render(int number) const { return base_.animate ? number : base_.total(); }
    RunResult render(const std::string& technique, int number) const;
    /// Adds a frame of each half, and updates the picture. Returns false, and changes nothing, if
    /// the frames took longer than `seconds`.
    bool add_frames(ReferencePicture& reference, int number,
                    double seconds = std::numeric_limits<double>::infinity());
    /// Replaces the frames by those of as many rays as fit into `seconds`. Returns whether it did.
    bool refine(ReferencePicture& reference, int wanted, double seconds);
    /// Sets the picture to the mean of the halves.
    void update_picture(ReferencePicture& reference) const;
    void read_stored(ReferencePicture& reference) const;
    ReferencePicture& find_reference(const std::string& samples, int number);

    Session& session_;
    const Request& base_;
    const std::string& reference_;
    const Watcher& watcher_;
    bool begins_coarse_;
    /// References by sample count and frame.
    std::map<std::pair<std::string, int>, ReferencePicture> truths_;
    /// First hits of the reference's camera rays, by frame number.
    std::map<int, std::vector<std::uint32_t>> hits_;
    mutable std::optional<bool> noisy_;
    std::filesystem::path file_; ///< file of the reference, see keep_in_file; empty: none
};

} // namespace catoptric::study
