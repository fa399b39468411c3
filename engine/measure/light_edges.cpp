#include "measure/light_edges.hpp"

#include "measure/metric.hpp"

#include <cmath>

namespace catoptric::measure {

namespace {

constexpr std::string_view kMirrors = "mirrors";
constexpr int kBesideRmse = 104; // order of columns that stand beside rmse

template <double LightEdges::*Figure>
Value figure(const Row& row) {
    return row.light_edges ? (*row.light_edges).*Figure : NAN;
}

const Registered kRmse{
    {.name = "light_edges/rmse",
     .help = "part of the rmse from pixels that looked within a texel of a light's outline; the "
             "squares of this part and of rest_rmse add up to that of rmse",
     .mask = kMirrors,
     .better = Better::less,
     .order = 255,
     .columns = {{.title = "rmse, light edges", .order = kBesideRmse}},
     .get = figure<&LightEdges::rmse>}};
const Registered kRest{{.name = "light_edges/rest_rmse",
                        .help = "part of the rmse from all other pixels",
                        .mask = kMirrors,
                        .better = Better::less,
                        .order = 256,
                        .columns = {{.title = "rmse, rest", .order = kBesideRmse}},
                        .get = figure<&LightEdges::rest_rmse>}};
const Registered kShare{{.name = "light_edges/share",
                         .help = "share of the squared error in pixels that looked within a texel "
                                 "of a light's outline",
                         .mask = kMirrors,
                         .order = 257,
                         .get = figure<&LightEdges::share>}};
const Registered kPixels{
    {.name = "light_edges/pixels",
     .help = "share of the pixels that looked within a texel of a light's outline",
     .mask = kMirrors,
     .order = 258,
     .get = figure<&LightEdges::pixels>}};

struct Sum {
    /// Finite pixels, and the mean square of a channel times their number.
    double pixels = 0, squares = 0;
};

Sum sum_of(const Difference& error) {
    const auto judged = static_cast<double>(error.pixels - error.nonfinite);
    return {judged, judged > 0 ? error.rmse * error.rmse * judged : 0};
}

} // namespace

LightEdges light_edges(const Difference& there, const Difference& elsewhere) {
    const Sum edges = sum_of(there), rest = sum_of(elsewhere);
    const double pixels = edges.pixels + rest.pixels, squares = edges.squares + rest.squares;
    if (!(pixels > 0)) return {};
    return {edges.pixels / pixels, squares > 0 ? edges.squares / squares : 0,
            std::sqrt(edges.squares / pixels), std::sqrt(rest.squares / pixels)};
}

} // namespace catoptric::measure
