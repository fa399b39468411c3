// catoptric info: version, device, features.
#include "app/engine.hpp"
#include "core/error.hpp"
#include "json.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "scene/load.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

InfoFacts gather(const std::string& device) {
    InfoFacts facts;
    try {
        facts.device = app::Engine({.device = device}).device();
    } catch (const Error& error) {
        if (error.failure != Failure::no_device) throw;
        facts.why_no_device = error.what();
    }
    std::vector<std::string> techniques, scenes;
    for (const app::TechniqueInfo& technique : app::techniques())
        techniques.push_back(technique.name);
    for (const scene::BuiltIn& scene : scene::built_in_scenes()) scenes.push_back(scene.name);
    facts.features = {{"techniques", techniques},
                      {"scenes", scenes},
                      {"scene_files", {"glb", "gltf", "obj"}},
                      {"picture_files", {"exr", "png"}},
                      {"models", {"everything"}},
                      {"timings", {"isolated", "pipelined"}}};
    return facts;
}

std::string text_of(const InfoFacts& facts) {
    std::string text = fmt::format("catoptric {} ({})\n", app::version(), app::commit());
    if (facts.device) {
        const app::DeviceInfo& device = *facts.device;
        const std::string threads = device.threads > 0 ? fmt::format(", {} threads", device.threads)
                                                       : "";
        text += fmt::format("{:<14} {} ({}, Vulkan {}, {}{})\n", "device", device.name, device.type,
                            device.api, device.driver, threads);
    } else {
        text += fmt::format("{:<14} none: {}\n", "device", facts.why_no_device);
    }
    for (const auto& [group, names] : facts.features)
        text += fmt::format("{:<14} {}\n", group, join(names));
    return text;
}

} // namespace

void add_info(CommandLine& program) {
    struct Options {
        Manners manners;
        std::string device;
    };
    const auto options = std::make_shared<Options>();
    Verb& verb = program.add("info", "version, device and features");
    verb.examples("Example:\n  catoptric info --json");
    verb.option("--device", "D", "index from 0 or part of a name (the fastest kind)",
                options->device);
    add_manners(verb, options->manners);
    verb.does([options] {
        const InfoFacts facts = gather(options->device);
        put(options->manners.json ? info_json(facts) : text_of(facts));
        return 0;
    });
}

} // namespace catoptric::cli
