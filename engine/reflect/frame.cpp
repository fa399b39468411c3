#include "reflect/frame.hpp"

#include "reflect/captures.hpp"
#include "reflect/mirrored.hpp"
#include "reflect/rough.hpp"
#include "render/ambient_occlusion.hpp"
#include "require/model.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

namespace catoptric::reflect {

namespace {

/// Declares the opaque picture, if some glass looks it up. It has levels if some mirror of such a
/// technique is rough, because shaders of rough mirrors read them.
std::optional<render::OpaquePicture>
declare_opaque_picture_of_techniques(graph::Graph& graph, const render::FrameInputs& inputs,
                                     const TechniqueOfEachMirror& assignment) {
    bool is_read = false, has_levels = false;
    for (std::uint32_t mirror = 0; mirror < assignment.of_mirror.size(); ++mirror) {
        const KnobsSharedByTechniques& knobs =
            assignment.choices[assignment.of_mirror[mirror]].shared;
        if (knobs.refract != render::kRefractScreen) continue;
        const std::size_t object = inputs.scene.object_index_of_mirror(mirror);
        is_read = is_read || inputs.scene.list_draw_ranges()[object].glass;
        has_levels = has_levels ||
                     (knobs.uses_filtered_levels() && inputs.scene.is_rough_mirror(mirror));
    }
    if (!is_read) return std::nullopt;
    return render::declare_opaque_picture(graph, inputs, has_levels);
}

/// The shadow map that a pass reads, and how.
struct ShadowMapRequest {
    std::optional<std::uint32_t> edge; ///< texels; none: the pass needs no shadow map
    bool is_soft = false;              ///< whether lamps cast soft shadows
};

ShadowMapRequest choose_shadow_map(const KnobsSharedByTechniques& knobs) {
    if (knobs.shadow != KnobsSharedByTechniques::ShadowMethod::map) return {};
    return {knobs.shadow_map, knobs.has_soft_shadows};
}

/// Shadow maps by edge in texels. Each is added to the graph once.
class ShadowMaps {
public:
    /// `probes`: light probes that light all passes; null: none.
    ShadowMaps(graph::Graph& graph, const render::FrameInputs& inputs,
               const require::RequiredWorkModel& model,
               const std::optional<render::LightProbeImages>& probes)
        : frame_graph_(graph), shadow_frame_inputs_(inputs), model_(model), probes_(probes) {}

    render::ShadingLights find_or_add_shadow_map(const ShadowMapRequest& wanted) {
        if (!wanted.edge) return {.probes = probes_};
        render::ShadingLights lighting = find_or_add_shadow_map_of_edge(*wanted.edge);
        const render::GpuScene& scene = shadow_frame_inputs_.scene;
        lighting.has_soft_shadows = wanted.is_soft && lighting.shadow_map &&
                                    scene.has_lamp_extents();
        if (lighting.has_soft_shadows) scene.request_lamp_extents();
        return lighting;
    }

private:
    render::ShadingLights find_or_add_shadow_map_of_edge(std::uint32_t edge) {
        const auto found = made_.find(edge);
        if (found != made_.end()) return found->second;
        const std::string suffix = made_.empty() ? "" : "." + std::to_string(edge);
        render::ShadingLights lighting{
            render::add_shadow_passes(frame_graph_, shadow_frame_inputs_, edge, model_, suffix),
            probes_};
        if (lighting.shadow_map && shadow_frame_inputs_.scene.has_tinted_shadows())
            lighting.glass_depths = render::add_glass_shadow_passes(
                frame_graph_, shadow_frame_inputs_, *lighting.shadow_map, edge, suffix);
        return made_[edge] = lighting;
    }

    graph::Graph& frame_graph_;
    const render::FrameInputs& shadow_frame_inputs_;
    const require::RequiredWorkModel& model_;
    std::optional<render::LightProbeImages> probes_;
    std::map<std::uint32_t, render::ShadingLights> made_;
};

/// Returns whether the ray tracer draws all parts of the view that the rasteriser cannot finish
/// (Technique::completes_view).
bool is_view_drawn_by_tracer_after_raster(const std::vector<TechniqueChoice>& choices) {
    const TechniqueChoice& choice = choices.front();
    const Technique& technique = *choice.technique;
    return choices.size() == 1 && technique.completes_view &&
           technique.completes_view(choice.settings);
}

/// Returns the view's shadow map: the finest that a technique asks for, read softly if one
/// technique asks for it. `is_drawn`: the view is rasterised although a technique traces shadow
/// rays, so it needs a shadow map.
ShadowMapRequest choose_shadow_map_for_view(const std::vector<TechniqueChoice>& choices,
                                            bool is_drawn) {
    if (!is_drawn) return choose_shadow_map(choices.front().shared);
    ShadowMapRequest wanted;
    for (const TechniqueChoice& choice : choices) {
        if (choice.shared.shadow == KnobsSharedByTechniques::ShadowMethod::none) continue;
        wanted.edge = std::max(wanted.edge.value_or(1), choice.shared.shadow_map);
        wanted.is_soft = wanted.is_soft || choice.shared.has_soft_shadows;
    }
    return wanted;
}

/// Returns the capture options of each mirror: the options of its technique, extended by data that
/// searches need which read captures of other mirrors.
std::vector<render::CaptureOptions>
choose_capture_options(const render::FrameInputs& inputs, const TechniqueOfEachMirror& assignment,
                       ShadowMaps& maps, const render::ShadingLights& view_lighting) {
    std::vector<render::CaptureOptions> of_choice;
    render::CaptureOptions shared;
    for (const TechniqueChoice& choice : assignment.choices) {
        const Technique* const technique = choice.technique;
        render::CaptureOptions options{.face = 0, .lighting = view_lighting};
        if (technique->capture) {
            options = technique->capture(inputs, choice.settings);
            options.lighting = maps.find_or_add_shadow_map(choose_shadow_map(choice.shared));
            if (does_search_other_captures(choice.shared)) {
                shared.surfaces = shared.surfaces || options.surfaces;
                shared.second_layer = shared.second_layer || options.second_layer;
                shared.blended_alpha = std::min(shared.blended_alpha, options.blended_alpha);
                shared.distance = TexelFormat::r32f;
            }
        } else if (choice.shared.capture) {
            options.face = *choice.shared.capture;
            options.distance = TexelFormat::r32f; // parallax correction of mirrors in captures
                                                  // reads the distance
        }
        of_choice.push_back(options);
    }
    std::vector<render::CaptureOptions> of_mirror;
    for (const std::uint32_t choice : assignment.of_mirror) {
        render::CaptureOptions options = of_choice[choice];
        if (!options.distance) options.distance = shared.distance;
        options.surfaces = options.surfaces || shared.surfaces;
        options.second_layer = options.second_layer || shared.second_layer;
        options.blended_alpha = std::min(options.blended_alpha, shared.blended_alpha);
        of_mirror.push_back(options);
    }
    return of_mirror;
}

/// Returns how all mirrors inside captures are drawn: by look-ups in the captures of the last
/// frame.
render::ShaderOfEachMirror
choose_mirror_shaders_in_captures(graph::Graph& graph, const render::FrameCaptureUpdate& feeding,
                                  const TechniqueOfEachMirror& assignment,
                                  const RoughLevels& levels) {
    render::ShaderOfEachMirror looks;
    for (std::size_t i = 0; i < assignment.of_mirror.size(); ++i) {
        const TechniqueChoice& choice = assignment.choices[assignment.of_mirror[i]];
        const Technique& technique = *choice.technique;
        render::MirrorShader look; // without a fragment shader, the mirror is black
        const bool is_kept = feeding.kept != nullptr;
        if (feeding.last && feeding.last->places[i].has_capture() &&
            (feeding.was_there[i] || !is_kept)) {
            look.fragment = technique.capture ? technique.in_captures : "reflect/parallax.frag";
            look.captures = feeding.last;
            look.constants.emplace_back(
                "refract_model", choose_refraction_model_of_other_views(choice.shared.refract));
            look.blank = !feeding.was_there[i];
            const auto mirror = static_cast<std::uint32_t>(i);
            // The previous contents are requested even if the mirror is drawn black, because only
            // requested images exist in the next frame. Images of kept captures exist without a
            // request.
            if (!look.blank || !is_kept)
                levels.add_rough_lookup_to_shader(graph, std::span(&mirror, 1), choice.shared, look,
                                                  true);
        }
        const auto found = std::ranges::find_if(
            looks.looks, [&](const render::MirrorShader& other) {
                return other.fragment == look.fragment && other.constants == look.constants &&
                       other.images == look.images;
            });
        looks.of_mirror.push_back(static_cast<std::uint32_t>(found - looks.looks.begin()));
        if (found == looks.looks.end()) looks.looks.push_back(std::move(look));
    }
    return looks;
}

bool is_drawn_by_mirrored_views(const TechniqueChoice& choice) {
    return choice.technique->mirrored_views != nullptr;
}

/// The captures into which mirrors of this frame look, with their filtered levels for rough
/// mirrors.
struct MutualMirrorCaptures {
    render::FrameCaptureUpdate update;
    RoughLevels levels;
};

/// Declares the light probes of the frame if some technique needs them. If techniques ask for
/// different numbers of light probes, the largest number is used. If some technique has light
/// between surfaces, the light probes hold it for all techniques.
std::optional<render::LightProbes>
declare_light_probes_of_techniques(graph::Graph& graph, const render::FrameInputs& inputs,
                                   const std::vector<TechniqueChoice>& choices) {
    std::uint32_t most = 0, content = shared::kLightProbesOfEnvironment;
    for (const TechniqueChoice& choice : choices) {
        if (choice.shared.has_light_between_surfaces()) content = shared::kLightProbesOfSurfaces;
        if (choice.shared.has_light_between_surfaces() ||
            (choice.shared.uses_light_probes() && inputs.scene.has_environment_light()))
            most = std::max(most, choice.shared.most_light_probes);
    }
    if (most == 0) return std::nullopt;
    return render::declare_light_probes(graph, inputs, most, content);
}

/// Returns whether surfaces of the camera's view hide light from each other: some technique has
/// ao=screen, and the environment, ambient light or light probes light diffuse surfaces. Light
/// probes of ao=captures already know what hides the light. Adds a note on the effect of `ao`.
bool is_light_occluded_by_camera_view(const render::FrameInputs& inputs,
                                      const std::vector<TechniqueChoice>& choices,
                                      std::vector<std::string>& notes) {
    using Occlusion = KnobsSharedByTechniques::AmbientOcclusion;
    const auto is_some = [&](Occlusion occlusion) {
        return std::ranges::any_of(choices, [=](const TechniqueChoice& choice) {
            return choice.shared.occlusion == occlusion;
        });
    };
    const bool asks_screen = is_some(Occlusion::screen),
               asks_captures = is_some(Occlusion::captures);
    const bool has_light = std::ranges::any_of(choices, [](const TechniqueChoice& choice) {
        return choice.shared.has_light_between_surfaces();
    });
    const bool has_environment_probes = asks_captures && !has_light;
    if (asks_captures && has_light)
        notes.emplace_back("ao=captures has no effect beside indirect=captures, whose light probes "
                           "know what hides the environment");
    if (asks_screen && has_environment_probes)
        notes.emplace_back("ao=screen has no effect beside ao=captures, whose light probes know "
                           "what hides the environment");
    if (!asks_screen || has_environment_probes ||
        !(has_light || inputs.scene.has_environment_light()))
        return false;
    char note[96];
    std::snprintf(note, sizeof note, "ao=screen: surfaces up to %.3g world units away hide the %s",
                  render::find_ambient_occlusion_radius(inputs.scene),
                  has_light ? "light of light probes" : "environment");
    notes.emplace_back(note);
    return true;
}

/// Declares the captures of all techniques based on `reuse`, in which mirrors are drawn by the
/// captures of the last frame. Returns an empty update if no technique needs captures.
MutualMirrorCaptures add_capture_passes_with_feedback(
    graph::Graph& graph, const render::FrameInputs& inputs, const TechniqueOfEachMirror& assignment,
    const PreviousCaptureHistory& keeping, ShadowMaps& maps,
    const render::ShadingLights& view_lighting, const std::optional<render::LightProbes>& probes) {
    const auto add_probes = [&](render::ShaderOfEachMirror looks) {
        if (probes)
            render::add_light_probe_passes(graph, inputs, *probes, view_lighting, std::move(looks));
    };
    // Traced mirrors are drawn from captures inside mirrored views, so they need captures, too.
    const bool has_views = assignment.choices.size() > 1 &&
                           std::ranges::any_of(assignment.choices, is_drawn_by_mirrored_views);
    const auto captures_any = [](const TechniqueChoice& choice) {
        return choice.technique->capture != nullptr;
    };
    if (assignment.of_mirror.empty() ||
        !(has_views || std::ranges::any_of(assignment.choices, captures_any))) {
        add_probes(render::use_same_shader_for_mirrors(inputs.scene, {}));
        return {{}, RoughLevels(graph, inputs, nullptr, {})};
    }
    std::vector<render::CaptureOptions> options = choose_capture_options(inputs, assignment, maps,
                                                                         view_lighting);
    render::FrameCaptureUpdate feeding =
        keeping.model.is_everything
            ? render::update_all_captures(graph, inputs, "capture", std::move(options))
            : render::update_required_captures(graph, inputs, "capture", options, keeping.model,
                                               {keeping.before, keeping.comparisons, keeping.most});
    std::vector<KnobsSharedByTechniques> knobs;
    for (const std::uint32_t choice : assignment.of_mirror)
        knobs.push_back(assignment.choices[choice].shared);
    RoughLevels levels(graph, inputs, feeding.captures, knobs);
    render::ShaderOfEachMirror looks = choose_mirror_shaders_in_captures(graph, feeding, assignment,
                                                                         levels);
    add_probes(looks);
    render::add_capture_passes(graph, inputs, *feeding.captures, std::move(looks), feeding.work);
    render::add_capture_comparison_pass(graph, inputs, feeding);
    levels.add_passes(graph);
    return {std::move(feeding), std::move(levels)};
}

std::vector<std::uint32_t> list_mirrors_using_technique(std::size_t choice,
                                                        const TechniqueOfEachMirror& assignment) {
    std::vector<std::uint32_t> mirrors;
    for (std::uint32_t i = 0; i < assignment.of_mirror.size(); ++i)
        if (assignment.of_mirror[i] == choice) mirrors.push_back(i);
    return mirrors;
}

/// Returns how all mirrors inside mirrored views are drawn: as in the picture, but without ray
/// tracing. Mirrors that are only ray traced in the picture are drawn from their captures, if they
/// have any.
render::ShaderOfEachMirror
choose_mirror_shaders_in_mirrored_views(const TechniqueOutputs& outputs,
                                        const TechniqueOfEachMirror& assignment,
                                        render::ShaderOfEachMirror looks) {
    for (std::size_t i = 0; i < looks.looks.size(); ++i) {
        render::MirrorShader& look = looks.looks[i];
        std::erase_if(look.constants,
                      [](const auto& constant) { return constant.first == "tracer"; });
        remove_images_of_camera_view(look);
        const Technique& technique = *assignment.choices[i].technique;
        if (is_drawn_by_mirrored_views(assignment.choices[i])) look = {};
        if (technique.capture || !technique.picture) continue;
        look = {};
        if (assignment.choices[i].shared.is_black_in_others || !outputs.captures) continue;
        look.fragment = "reflect/parallax.frag";
        look.constants.emplace_back("refract_model", choose_refraction_model_of_other_views(
                                                         assignment.choices[i].shared.refract));
        look.captures = outputs.captures;
    }
    return looks;
}

} // namespace

TechniqueOutputs add_frame_passes(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const TechniqueOfEachMirror& assignment,
                                  const PreviousCaptureHistory& history) {
    const std::vector<TechniqueChoice>& choices = assignment.choices;
    const bool is_mixed = choices.size() > 1;
    const std::optional<render::LightProbes> probes = declare_light_probes_of_techniques(
        graph, inputs, choices);
    // With light probes, light goes from every surface to every other surface, so no work can be
    // left out.
    const PreviousCaptureHistory everything{.model = kDrawEverythingModel};
    const PreviousCaptureHistory& keeping = probes ? everything : history;
    ShadowMaps maps(graph, inputs, keeping.model,
                    probes ? std::optional(probes->images) : std::nullopt);
    const bool completes = is_view_drawn_by_tracer_after_raster(choices);
    const render::ShadingLights lighting = maps.find_or_add_shadow_map(
        choose_shadow_map_for_view(choices, is_mixed || completes));
    if (!is_mixed && !completes && choices.front().technique->picture) {
        TechniqueOutputs traced = choices.front().technique->picture(
            graph, inputs, choices.front().settings, lighting);
        traced.traces_all_mirrors = true;
        return traced;
    }
    TechniqueOutputs outputs;
    render::ShadingLights view_lighting = lighting;
    if (is_light_occluded_by_camera_view(inputs, choices, outputs.notes))
        view_lighting.ambient_occlusion = render::add_ambient_occlusion_passes(graph, inputs);
    const MutualMirrorCaptures feedback = add_capture_passes_with_feedback(
        graph, inputs, assignment, keeping, maps, lighting, probes);
    outputs.captures = feedback.update.captures;
    outputs.kept = feedback.update.kept;
    render::ShaderOfEachMirror looks{{}, assignment.of_mirror};
    std::vector<TracerSettings> tracers;
    std::optional<graph::ImageHandle> glass_backs;
    const std::optional<render::OpaquePicture> opaque = declare_opaque_picture_of_techniques(
        graph, inputs, assignment);
    const bool needs_looks = completes || !assignment.of_mirror.empty();
    for (std::size_t i = 0; i < choices.size() && needs_looks; ++i) {
        render::FrameInputs own = inputs;
        if (is_mixed) own.prefix += choices[i].file_name() + "/";
        const TechniqueKnobSettings& settings = choices[i].settings;
        const Technique& technique = *choices[i].technique;
        const MirrorShadingInputs around{
            outputs.captures,
            completes ? lighting
                      : maps.find_or_add_shadow_map(choose_shadow_map(choices[i].shared)),
            list_mirrors_using_technique(i, assignment), completes};
        MirrorShadingSetup look = technique.search
                                      ? MirrorShadingSetup{make_search_shader(technique, around,
                                                                              settings),
                                                           {}}
                                      : technique.look(graph, own, settings, around);
        if (look.mirror.captures == feedback.update.captures)
            feedback.levels.add_rough_lookup_to_shader(graph, around.mirrors, choices[i].shared,
                                                       look.mirror);
        if (choices[i].shared.refract == render::kRefractBackface && inputs.scene.has_glass()) {
            if (!glass_backs) glass_backs = render::add_glass_back_pass(graph, inputs);
            look.mirror.images.emplace_back(kGlassBackImage, std::vector{*glass_backs});
        }
        if (choices[i].shared.refract == render::kRefractScreen) {
            if (!opaque) remove_images_of_camera_view(look.mirror);
            if (opaque)
                look.mirror.images.emplace_back(kOpaquePictureImage, std::vector{opaque->colour});
            if (opaque && opaque->levels)
                look.mirror.images.emplace_back(kOpaqueLevelImage, std::vector{*opaque->levels});
        }
        if (opaque && look.tracer && look.tracer->first_raster) {
            // Glass would look up the numbers of triangles that such a shader draws.
            look.mirror.variant.clear();
            look.tracer->first_raster = false;
        }
        if (look.tracer) {
            if (!look.tracer->paths) {
                look.tracer->lighting.probes = lighting.probes;
                look.tracer->lighting.ambient_occlusion = view_lighting.ambient_occlusion;
            }
            tracers.push_back(*look.tracer);
            look.mirror.constants.emplace_back("tracer",
                                               static_cast<std::uint32_t>(tracers.size()));
        }
        if (!outputs.captures) outputs.captures = look.mirror.captures;
        looks.looks.push_back(std::move(look.mirror));
    }
    if (outputs.captures)
        outputs.notes.insert(outputs.notes.begin(), outputs.captures->notes.begin(),
                             outputs.captures->notes.end());
    outputs.draws_everything = probes.has_value();
    if (probes && !probes->note.empty()) outputs.notes.push_back(probes->note);
    if (probes && history.most > 0)
        outputs.notes.push_back("light probes need all captures, so no budget limits them");
    if (std::ranges::any_of(choices, is_drawn_by_mirrored_views) && !assignment.of_mirror.empty())
        std::ranges::move(
            add_mirrored_views(graph, inputs, assignment, lighting,
                               choose_mirror_shaders_in_mirrored_views(outputs, assignment, looks),
                               looks),
            std::back_inserter(outputs.notes));
    std::optional<render::GlassOverOpaquePicture> glass;
    if (opaque) {
        glass = {*opaque, looks};
        std::ranges::for_each(glass->opaque_looks.looks, remove_images_of_camera_view);
    }
    const render::CameraPassOutputs view = render::add_camera_view(
        graph, inputs, view_lighting, std::move(looks), !tracers.empty(),
        completes ? render::ShadingTracer{1, tracers.front().rays > 0} : render::ShadingTracer{},
        std::move(glass));
    outputs.hdr = view.hdr;
    if (inputs.with_lookup) outputs.lookup = view.lookup;
    if (inputs.with_lookup && !tracers.empty() && !completes) outputs.tracer_marks = view.tracers;
    outputs.traces_all_mirrors = completes;
    for (std::uint32_t i = 0; i < tracers.size(); ++i)
        outputs.counters.push_back(
            add_tracing_of_pixel_list(graph, inputs, tracers[i], i + 1, view));
    return outputs;
}

} // namespace catoptric::reflect
