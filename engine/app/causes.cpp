#include "app/causes.hpp"

#include "measure/difference.hpp"
#include "measure/masks.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace catoptric::app {

namespace {

/// How a picture is made.
struct Rendering {
    std::string technique;
    bool is_settled = false;  ///< history of this very instant: nothing is a frame late
    std::uint32_t mended = 0; ///< sum of shared::kMend...
    bool drawn_as_seen =
        false; ///< pixels where the rasteriser and the ray see different mirrors are true
    auto operator<=>(const Rendering&) const = default;
};

struct Step {
    const char* name;
    Rendering in_turn, alone;
};

/// The technique with distances stored as 32-bit floats.
std::string with_full_distance(const std::string& technique) {
    const TechniqueChoice choice = parse_technique(technique);
    std::string text = choice.technique;
    char separator = ':';
    for (const auto& setting : choice.settings) {
        if (!setting.changed || setting.name == "distance" || setting.name == "range") continue;
        text += separator + setting.name + "=" + setting.text;
        separator = ',';
    }
    return text;
}

bool has_full_distance(const std::string& technique) {
    return std::ranges::none_of(parse_technique(technique).settings, [](const auto& setting) {
        return setting.name == "distance" && setting.text != "r32f";
    });
}

std::vector<Step> steps_of(const std::string& technique) {
    const std::string full = has_full_distance(technique) ? technique
                                                          : with_full_distance(technique);
    const Rendering row{technique};
    Rendering chain{full};
    std::vector<Step> steps{{"storage format", chain, {full}}};
    const auto mend = [&](const char* name, std::uint32_t cause) {
        chain.mended |= cause;
        steps.push_back({name, chain, {technique, false, cause}});
    };
    mend("stored distance", shared::kMendDistance);
    mend("search direction", shared::kMendDirection);
    mend("hidden target", shared::kMendHidden);
    mend("texels", shared::kMendTexels);
    mend("mirror in mirror", shared::kMendMirrors);
    mend("own reflection", shared::kMendOwn);
    chain.is_settled = true;
    steps.push_back({"last frame", chain, {technique, true}});
    mend("shadow map", shared::kMendShadows);
    chain.drawn_as_seen = true;
    steps.push_back({"silhouettes", chain, {technique, false, 0, true}});
    return steps;
}

/// Frames until the row's own picture, or one that is settled at that picture's instant.
Request request_for(const Request& base, const Rendering& rendering) {
    constexpr int kSettled = 16; // deeper bounces are below a rounding of the picture's halves
    Request request = base;
    const int last = base.warmup + base.frames;
    const bool moves = base.animate && !rendering.is_settled;
    if (!moves) {
        request.time = base.instant(last);
        request.animate = false;
    }
    request.frames = 1;
    request.warmup = moves                  ? last - 1
                     : rendering.is_settled ? kSettled
                                            : std::min(last - 1, kSettled);
    request.techniques = {rendering.technique};
    return request;
}

using Pictures = std::map<Rendering, measure::Picture>;

/// All the pictures that the steps need, each technique and history run once.
Pictures render(Session& session, const Request& base, const Watcher& watcher,
                const std::string& technique, const std::vector<Step>& steps) {
    std::map<std::pair<std::string, bool>, std::vector<std::uint32_t>> runs;
    const auto want = [&](const Rendering& rendering) {
        std::vector<std::uint32_t>& masks = runs[{rendering.technique, rendering.is_settled}];
        if (rendering.mended && std::ranges::find(masks, rendering.mended) == masks.end())
            masks.push_back(rendering.mended);
    };
    want({technique});
    for (const Step& step : steps) want(step.in_turn), want(step.alone);
    Pictures pictures;
    for (const auto& [run, masks] : runs) {
        std::vector<measure::Picture> made = last_pictures(
            session, request_for(base, {run.first, run.second}), masks, watcher);
        pictures[{run.first, run.second}] = std::move(made[0]);
        for (std::size_t i = 0; i < masks.size(); ++i)
            pictures[{run.first, run.second, masks[i]}] = std::move(made[i + 1]);
    }
    return pictures;
}

/// Mean squared errors over the pixels of all mirrors and of each.
struct SquaredError {
    double all = 0;
    std::vector<double> per_mirror;
};

} // namespace

std::vector<measure::Picture> last_pictures(Session& session, const Request& request,
                                            const std::vector<std::uint32_t>& mended,
                                            const Watcher& watcher) {
    std::vector<measure::Picture> pictures(1);
    Frames frames(session, request);
    for (int k = 1; k < request.total(); ++k) frames.next(), watcher.check_stopped();
    FrameSpec aside = request;
    aside.time = request.instant(request.total());
    aside.timing = Timing::pipelined;
    aside.is_aside = true;
    for (const std::uint32_t causes : mended) {
        aside.mended = causes;
        pictures.push_back(session.frame(aside).hdr());
        watcher.check_stopped();
    }
    frames.next();
    pictures.front() = frames.frame().hdr();
    return pictures;
}

CauseFinder::CauseFinder(Session& session, const Request& base, const measure::Picture& truth,
                         const std::vector<std::uint32_t>& hits, const Watcher& watcher)
    : session_(session), base_(base), truth_(truth), hits_(hits), watcher_(watcher) {
    for (const std::uint32_t hit : hits)
        mirrors_ = std::max(mirrors_, measure::first_mirror(hit).number());
    // A technique that follows no ray through other mirrors names the one that it draws.
    Request request = request_for(base, {"naive:bounces=1,face=1,shadow=none"});
    request.with_lookup = true;
    const Result result = run(session, request);
    for (const vec4& pixel : result.parts.front().lookup)
        drawn_.push_back(pixel.w > 0 ? (static_cast<std::uint32_t>(pixel.w) - 1) / 8 + 1 : 0);
}

report::Causes CauseFinder::find(const std::string& technique) const {
    const std::vector<Step> steps = steps_of(technique);
    const Pictures pictures = render(session_, base_, watcher_, technique, steps);
    const std::vector<float> no_flip(truth_.pixels.size());
    const auto error_of = [&](Rendering rendering) {
        const bool drawn_as_seen = std::exchange(rendering.drawn_as_seen, false);
        measure::Picture picture = pictures.at(rendering);
        for (std::size_t i = 0; drawn_as_seen && i < drawn_.size(); ++i)
            if (drawn_[i] != measure::first_mirror(hits_[i]).number())
                picture.pixels[i] = truth_.pixels[i];
        const auto squared = [&](const measure::Mask& mask) {
            const double rmse = measure::difference(picture, truth_, mask, no_flip).rmse;
            return rmse * rmse;
        };
        SquaredError error{squared(measure::mirrors(hits_)), {}};
        for (std::uint32_t mirror = 1; mirror <= mirrors_; ++mirror)
            error.per_mirror.push_back(squared(measure::of_mirror(hits_, MirrorId(mirror))));
        return error;
    };
    const auto fall = [](const SquaredError& from, const SquaredError& to) {
        SquaredError fallen{from.all - to.all, {}};
        for (std::size_t i = 0; i < from.per_mirror.size(); ++i)
            fallen.per_mirror.push_back(from.per_mirror[i] - to.per_mirror[i]);
        return fallen;
    };
    const SquaredError row = error_of({technique});
    report::Causes causes{row.all, row.per_mirror, {}, 0, 0};
    SquaredError before = row;
    for (const Step& step : steps) {
        const SquaredError after = error_of(step.in_turn);
        const SquaredError in_turn = fall(before, after), alone = fall(row, error_of(step.alone));
        causes.list.push_back(
            {step.name, in_turn.all, alone.all, in_turn.per_mirror, alone.per_mirror});
        before = after;
    }
    causes.rest_rmse = std::sqrt(before.all);
    return causes;
}

} // namespace catoptric::app
