// The options for scene overrides.
#include "core/error.hpp"
#include "core/text.hpp"
#include "import/scene_file.hpp"
#include "options.hpp"
#include "parse.hpp"

namespace catoptric::cli {

namespace {

const std::string kSceneOptionsHeading = "The scene";

void add_surface_options(Verb& verb, scene::SceneOverrides& overrides) {
    const auto mirror = [&](const std::string& text) {
        overrides.mirrors.push_back(scene::parse_mirror_override("--mirror", text));
    };
    verb.heading(kCommonOptions);
    verb.repeated(
        "--mirror", "PATTERN[=R][,roughness=A]",
        "make mirrors of objects or materials with this name (* ? [...]); R is the reflectance, a "
        "number or r,g,b from 0 to 1 (1); a roughness A above 0 makes them metals; may be repeated",
        mirror);
    verb.heading(kSceneOptionsHeading);
    verb.repeated(
        "--light", "PATTERN",
        "make lamps of emitting objects or materials with this name, also if a texture varies the "
        "emission; may be repeated",
        [&](const std::string& text) { overrides.lights.push_back(text); });
    verb.option("--light-samples", "N",
                "points that replace each lamp and each cast a shadow, from 1 to 128 (1)",
                [&](const std::string& text) {
                    overrides.light_samples = static_cast<int>(
                        parse_integer("--light-samples", text, 1, scene::kMaxLightSamples));
                });
    verb.option("--mirror-max-roughness", "A", "largest roughness of a mirror, from 0 to 1 (0.6)",
                [&](const std::string& text) {
                    overrides.mirror_max_roughness = parse_real("--mirror-max-roughness", text, 0,
                                                                1);
                });
    verb.flag("--dielectric-mirrors", "surfaces that are no metal are mirrors, too",
              [&] { overrides.dielectric_mirrors = true; });
    verb.option(
        "--multiple-scattering", "NAME",
        "light that rough surfaces scatter several times: none (it is lost) or turquin (none)",
        [&](const std::string& text) {
            check(text == "none" || text == "turquin", Failure::usage,
                  "--multiple-scattering: wanted none or turquin, found ", quote(text));
            overrides.multiple_scattering = text == "turquin";
        });
    verb.option("--glass-shadow", "NAME",
                "shadow of glass: none (all light passes) or tint (the light that straight rays "
                "through it leave) (none)",
                [&](const std::string& text) {
                    check(text == "none" || text == "tint", Failure::usage,
                          "--glass-shadow: wanted none or tint, found ", quote(text));
                    overrides.tints_glass_shadows = text == "tint";
                });
}

void add_environment_options(Verb& verb, scene::SceneOverrides& overrides) {
    verb.option(
        "--environment", "E",
        "picture around the scene that also lights it: FILE.exr, .hdr or .png (equirectangular; "
        "FILE:LAYER for one of several layers), studio or none (none; studio for a file without a "
        "light)",
        [&](const std::string& text) {
            check(!text.empty(), Failure::usage,
                  "--environment: wanted FILE.exr, .hdr or .png, studio or none, found ''");
            overrides.environment = text;
        });
    verb.option("--environment-shadows", "N",
                "rays from each traced surface to the environment, from 0 to 1024, so that objects "
                "hide its light; rasterised surfaces stay unshadowed; 0: no shadows (0)",
                [&](const std::string& text) {
                    overrides.environment_shadows = static_cast<int>(parse_integer(
                        "--environment-shadows", text, 0, scene::kMaxEnvironmentShadows));
                });
    verb.option("--environment-scale", "S", "factor for the light of the environment (1)",
                [&](const std::string& text) {
                    overrides.environment_scale = parse_real("--environment-scale", text, 0,
                                                             scene::kMaxLightScale);
                });
    verb.option("--environment-rotate", "DEG",
                "rotation of the environment in degrees, from -z towards +x (0)",
                [&](const std::string& text) {
                    overrides.environment_rotation = parse_real("--environment-rotate", text,
                                                                -scene::kMaxRotationDegrees,
                                                                scene::kMaxRotationDegrees);
                });
    verb.option(
        "--ambient", "A", "constant light on every surface, at least 0 (0.05; 0 in an environment)",
        [&](const std::string& text) { overrides.ambient = parse_real("--ambient", text, 0); });
}

void add_scale_and_axis_options(Verb& verb, scene::SceneOverrides& overrides) {
    verb.option("--up", "AXIS", "axis that points up in the file, y or z; z is turned to y (y)",
                [&](const std::string& text) {
                    overrides.up = parse_choice("--up", text, {"y", "z"}) == 1 ? scene::UpAxis::z
                                                                               : scene::UpAxis::y;
                });
    verb.option("--animation", "NAME", "animation of a glTF file to play, or none (the first)",
                [&](const std::string& text) { overrides.animation = text; });
}

} // namespace

void add_camera_options(Verb& verb, CommonOptions& common) {
    scene::SceneOverrides& overrides = common.overrides;
    verb.option(
        "--camera", "C",
        "camera: name, index from 0, EX,EY,EZ:TX,TY,TZ:FOV (eye, target, degrees), "
        "EX,EY,EZ:TX,TY,TZ:h=HEIGHT (orthographic), or seeded (random from --seed, with a mirror "
        "in view) (the file's first, or a three-quarter view)",
        [&](const std::string& text) {
            if (!text.empty()) overrides.camera = text;
        });
    verb.option(
        "--exposure", "STOPS",
        "exposure: light is multiplied by 2^STOPS; auto: the brightest 5 % of the picture are "
        "above .8 (the scene's; auto for files)",
        [&](const std::string& text) {
            overrides.exposure = scene::ExposureOverride{};
            if (text != "auto") overrides.exposure->stops = parse_stops(text);
        });
}

void add_override_options(Verb& verb, CommonOptions& common) {
    verb.heading(kSceneOptionsHeading);
    verb.option("--root", "DIR",
                "additional folder for files that SCENE names (only the scene's own folder)",
                [&](const std::string& text) {
                    check(!text.empty(), Failure::usage, "--root: wanted a folder, found ''");
                    common.root = text;
                });
    const auto add_most = [&](const std::string& option, const std::string& help,
                              std::optional<std::uint64_t>& most) {
        verb.option(option, "N", help, [option, &most](const std::string& text) {
            constexpr std::int64_t kMaxBudgetValue = std::int64_t{1} << 40;
            most = static_cast<std::uint64_t>(parse_integer(option, text, 1, kMaxBudgetValue));
        });
    };
    add_most("--max-bytes", "limit for the bytes of the scene's files (an eighth of free memory)",
             common.budget.bytes);
    add_most(
        "--max-triangles",
        "limit for the triangles of the scene's meshes, with three vertices each (follows from "
        "file size and free memory)",
        common.budget.triangles);
    add_surface_options(verb, common.overrides);
    add_environment_options(verb, common.overrides);
    add_scale_and_axis_options(verb, common.overrides);
    verb.flag("--no-scene-file", "ignore SCENE.catoptric.json",
              [&] { common.use_scene_file = false; });
    verb.heading(kCommonOptions);
    // The parser takes options in the order in which they are added, so this one wins.
    verb.repeated("--set", "KEY=VALUE",
                  "set a key of SCENE.catoptric.json, such as ambient=0 or lights=lamp*; wins over "
                  "the option of that name; may be repeated",
                  [&common](const std::string& text) {
                      common.overrides = scene::combine(scene::read_override(text),
                                                        common.overrides);
                  });
}

} // namespace catoptric::cli
