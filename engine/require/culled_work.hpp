#pragma once

#include "require/sight.hpp"

#include <optional>
#include <vector>

/// Describes culled work and its reasons in words.
namespace catoptric::require {

/// Results of the rules that are not part of the model.
struct VisibilityFindings {
    /// For each mirror: the reason why the camera does not see the mirror; empty if the camera sees
    /// the mirror.
    std::vector<std::optional<UnseenReason>> camera;
    /// All values that the explaining sentences of `graph --why` depend on. The sentences are built
    /// again only if the key changes.
    std::vector<std::uint64_t> key;
};
void set_key(VisibilityFindings& findings, const WorkModel& model);

/// Returns numbers in ascending order as text: "1", "2-5", "1-3, 7".
std::string format_ranges(const std::vector<std::size_t>& numbers);

/// Returns the captures, faces and shadow maps that the model culls. Mirrors with the same reason
/// share one entry.
std::vector<CulledWork> find_culled_work(const WorkModel& model, const VisibilityFindings& findings,
                                         const scene::Scene& scene);

/// Returns a light's name in quotes. Empty if a lamp's mesh makes several lights, because then no
/// light has a name.
std::string quote_light_name(const scene::Scene& scene, std::size_t light, std::size_t count);
/// Returns "+X -Y", for example.
std::string face_names(FaceBits faces);

} // namespace catoptric::require
