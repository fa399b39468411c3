// Metrics of a row's error split by cause.
#include "measure/causes.hpp"

#include "measure/metric.hpp"

#include <cmath>

namespace catoptric::measure {

namespace {

constexpr std::string_view kMirrors = "mirrors";

template <double Causes::*Figure>
Value figure(const Row& row) {
    return row.causes ? (*row.causes).*Figure : NAN;
}

Value list_of(const Row& row) {
    std::vector<Parts> list;
    if (!row.causes) return list;
    for (const Cause& cause : row.causes->list)
        list.push_back({"cause",
                        cause.name,
                        {{"share", cause.share},
                         {"share_first_order", cause.share_first_order},
                         {"share_mirror_in_mirror", cause.share_mirror_in_mirror},
                         {"share_per_mirror", cause.share_per_mirror},
                         {"squared_error", cause.squared_error},
                         {"alone", cause.alone},
                         {"alone_per_mirror", cause.alone_per_mirror}}});
    return list;
}

const Registered kSquaredError{{.name = "causes/squared_error",
                                .help = "mean square difference, the row's own, which causes share",
                                .mask = kMirrors,
                                .better = Better::less,
                                .order = 270,
                                .get = figure<&Causes::squared_error>}};
const Registered kPerMirror{{.name = "causes/squared_error_per_mirror",
                             .help = "the same of each mirror",
                             .mask = kMirrors,
                             .better = Better::less,
                             .order = 271,
                             .get = [](const Row& row) -> Value {
                                 return row.causes ? row.causes->squared_error_per_mirror
                                                   : std::vector<double>();
                             }}};
const Registered kRest{{.name = "causes/rest_rmse",
                        .help = "rmse when all is mended: near 0 where no cause is missing",
                        .mask = kMirrors,
                        .order = 272,
                        .get = figure<&Causes::rest_rmse>}};
const Registered kAtLightEdges{
    {.name = "causes/at_light_edges",
     .help = "share of the squared error in pixels that looked within a texel of a light's outline",
     .mask = kMirrors,
     .order = 273,
     .get = [](const Row& row) -> Value {
         return row.causes && row.light_edges ? row.light_edges->share : NAN;
     }}};
const Registered kList{{.name = "causes/list",
                        .help = "each cause's share of the squared error (Shapley for five of "
                                "them), 1 in sum over all, and what goes when it is mended alone",
                        .mask = kMirrors,
                        .order = 274,
                        .get = list_of}};

} // namespace

} // namespace catoptric::measure
