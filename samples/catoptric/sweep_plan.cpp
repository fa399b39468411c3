#include "sweep_plan.hpp"

#include "axis_option.hpp"
#include "compare_words.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "measure/metric.hpp"
#include "measure/views.hpp"
#include "report/json.hpp"
#include "scene/built_in.hpp"
#include "scene/hash.hpp"
#include "study/compare_checks.hpp"
#include "study/study.hpp"
#include "study/views.hpp"

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace catoptric::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxSweepFileBytes = 1U << 20U;
constexpr std::uintmax_t kMaxPlanBytes = 1U << 30U;
constexpr std::uintmax_t kMaxResultBytes = 64U << 20U;
constexpr std::uint64_t kMaxPieceCount = 1'000'000;
constexpr std::int64_t kMaxViewCount = 10'000, kMaxRepeatCount = 1'000, kMaxSeed = 1'000'000'000;

/// Options whose value is a file or folder. In a sweep's file, the path is relative to the folder
/// of the sweep's file.
constexpr std::array<std::string_view, 3> kPathOptions{"root", "environment", "device-profile"};
/// Words that a path option accepts instead of a file name.
constexpr std::array<std::string_view, 2> kPathOptionWords{"studio", "none"};
/// Options of `compare` that a sweep refuses, because the sweep sets them itself or because they
/// write files. Options of studies are refused, too.
constexpr std::string_view kRefusedOptions[] = {"output",        "techniques",
                                                "axis",          "row",
                                                "together",      "max-ms",
                                                "max-flip",      "baseline",
                                                "max-flip-rise", "max-time-ratio",
                                                "summary",       "junit",
                                                "csv",           "json",
                                                "figures",       "crop",
                                                "inline",        "cameras-per-instant",
                                                "quiet",         "verbose",
                                                "progress",      "reference-seconds",
                                                "help",          "version"};

std::string describe(const SweepJson& value) { return report::describe(value); }

/// A place in a sweep's file, for messages.
struct SweepPlace {
    std::string text;

    SweepPlace member(std::string_view name) const { return {text + "." + std::string(name)}; }
    template <typename... Parts>
    void check(bool ok, const Parts&... parts) const {
        catoptric::check(ok, Failure::bad_data, text, ": ", parts...);
    }
};

std::int64_t read_whole_number(const SweepJson& value, std::int64_t low, std::int64_t high,
                               const SweepPlace& place) {
    place.check(value.is_number_integer() && value >= low && value <= high,
                "wanted a whole number from ", low, " to ", high, ", found ", describe(value));
    return value.get<std::int64_t>();
}

const SweepJson& read_list(const SweepJson& object, const char* member, const SweepPlace& place) {
    const SweepPlace at = place.member(member);
    at.check(object.contains(member), "wanted a list, found nothing");
    const SweepJson& list = object[member];
    at.check(list.is_array() && !list.empty(), "wanted a list that is not empty, found ",
             describe(list));
    return list;
}

std::vector<std::string> read_texts(const SweepJson& list, const SweepPlace& place) {
    std::vector<std::string> texts;
    for (const SweepJson& value : list) {
        place.check(value.is_string() && !value.get_ref<const std::string&>().empty(),
                    "wanted texts, found ", describe(value));
        texts.push_back(value.get<std::string>());
    }
    return texts;
}

void check_members(const SweepJson& object, std::initializer_list<std::string_view> names,
                   const SweepPlace& place) {
    place.check(object.is_object(), "wanted an object, found ", describe(object));
    for (const auto& [name, value] : object.items())
        place.check(std::ranges::find(names, name) != names.end(), "wanted ",
                    fmt::format("{}", fmt::join(names, ", ")), ", found ", quote(name));
}

/// Returns the value of a knob or option as command-line text.
std::string option_text(const SweepJson& value, const SweepPlace& place) {
    place.check(value.is_string() || value.is_number(), "wanted text or a number, found ",
                describe(value));
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Returns a path from the sweep's file, relative to the folder of the plan.
std::string path_from_plan(const std::string& path, const fs::path& file, const fs::path& folder) {
    if (fs::path(path).is_absolute()) return path;
    const fs::path whole = real_path(real_path(file).parent_path() / path);
    return whole.lexically_relative(real_path(folder)).string();
}

/// Returns a path of the plan, relative to the working folder.
std::string path_from_cwd(const std::string& path, const fs::path& folder) {
    if (fs::path(path).is_absolute()) return path;
    return (real_path(folder) / path)
        .lexically_normal()
        .lexically_proximate(real_path("."))
        .string();
}

bool is_path_option(const std::string& name, const std::string& value) {
    return std::ranges::find(kPathOptions, name) != kPathOptions.end() &&
           std::ranges::find(kPathOptionWords, value) == kPathOptionWords.end();
}

bool is_built_in(const std::string& name) {
    return std::ranges::find(scene::built_in_scenes(), name, &scene::BuiltInScene::name) !=
           scene::built_in_scenes().end();
}

/// The contents of a sweep's file, after all members were checked.
struct SweepRequest {
    std::vector<std::string> scenes, techniques;
    std::vector<KnobAxis> knobs;
    SweepJson options = SweepJson::object();
    std::vector<std::pair<std::string, SweepJson>> axes; ///< option and its values
    std::int64_t view_count = 1, view_seed = 1, cameras_per_instant = 1;
    std::int64_t timing_repeats = 1;
};

void check_option(const std::string& name, const CompletionOption*& option,
                  const std::vector<CompletionOption>& known, const SweepPlace& place) {
    const auto found = std::ranges::find(known, "--" + name, &CompletionOption::name);
    place.check(found != known.end(), "'compare' has no option '--", name, "'");
    const bool is_refused = std::ranges::find(kRefusedOptions, name) != std::end(kRefusedOptions) ||
                            std::ranges::find(study::studies(), name, &study::Study::name) !=
                                study::studies().end();
    place.check(!is_refused, "a sweep cannot set this option of compare",
                name == "reference-seconds"
                    ? ": the reference has as many rays as its knob 'rays', so that results repeat"
                    : "");
    option = &*found;
}

/// Returns the value of an option: true for an option without a value, else text or a list of
/// texts. Each path is seen from the folder of the plan.
SweepJson read_option(const std::string& name, const SweepJson& value, const fs::path& file,
                      const fs::path& folder, const SweepPlace& place) {
    static const std::vector<CompletionOption> kOptions = compare_options();
    const CompletionOption* option = nullptr;
    check_option(name, option, kOptions, place);
    if (!option->takes_value) {
        place.check(value == true, "wanted true, because the option has no value, found ",
                    describe(value));
        return true;
    }
    SweepJson list = value.is_array() ? value : SweepJson::array({value});
    place.check(!list.empty(), "wanted at least one value, found an empty list");
    for (SweepJson& entry : list) {
        std::string text = option_text(entry, place);
        place.check(name != "reference" || !text.ends_with(".exr"),
                    "wanted a technique, found a file");
        place.check(name != "model" || text != "both", "wanted everything or required, found both");
        if (is_path_option(name, text)) text = path_from_plan(text, file, folder);
        entry = text;
    }
    return list.size() == 1 ? list.front() : list;
}

/// Returns the scenes of a sweep's file. Paths of scene files are relative to the folder of the
/// plan.
std::vector<std::string> read_scenes(const SweepJson& document, const fs::path& file,
                                     const fs::path& folder, const SweepPlace& place) {
    std::vector<std::string> scenes;
    for (const std::string& scene :
         read_texts(read_list(document, "scenes", place), place.member("scenes"))) {
        place.member("scenes").check(!scene.starts_with('-'), "wanted a scene, found ",
                                     quote(scene));
        scenes.push_back(is_built_in(scene) ? scene : path_from_plan(scene, file, folder));
    }
    return scenes;
}

std::vector<std::string> read_techniques(const SweepJson& document, const SweepPlace& place) {
    if (!document.contains("techniques")) return {};
    const SweepPlace at = place.member("techniques");
    std::vector<std::string> rows = read_texts(read_list(document, "techniques", place), at);
    for (const std::string& row : rows) {
        at.check(!row.starts_with('-'), "wanted a technique, found ", quote(row));
        at.check(!row.starts_with("plan:"),
                 "wanted the rules of a plan as text, because its file "
                 "may change, found ",
                 quote(row));
    }
    return rows;
}

/// Throws an error if the sweep would have more pieces than a plan may have. Called before any
/// piece is made.
void check_piece_count(const SweepRequest& sweep, const SweepPlace& place) {
    std::uint64_t count = sweep.scenes.size();
    const auto multiply = [&](std::uint64_t factor) {
        count = count > kMaxPieceCount ? count : count * factor;
    };
    for (const auto& [name, values] : sweep.axes) multiply(values.size());
    multiply(static_cast<std::uint64_t>(sweep.view_count + sweep.timing_repeats));
    place.member("axes").check(count <= kMaxPieceCount, "wanted a sweep of at most ",
                               kMaxPieceCount, " pieces, found more");
}

SweepRequest read_request(const SweepJson& document, const fs::path& file, const fs::path& folder) {
    const SweepPlace place{file.string()};
    check_members(document,
                  {"schema", "scenes", "techniques", "knobs", "options", "axes", "views", "timing"},
                  place);
    place.member("schema").check(
        !document.contains("schema") || document["schema"] == "catoptric/sweep/1",
        "wanted catoptric/sweep/1, found ", describe(document.value("schema", SweepJson())));
    SweepRequest sweep;
    sweep.scenes = read_scenes(document, file, folder, place);
    sweep.techniques = read_techniques(document, place);
    const auto object = [&](const char* member) {
        SweepJson value = document.value(member, SweepJson::object());
        place.member(member).check(value.is_object(), "wanted an object, found ", describe(value));
        return value;
    };
    const SweepJson knobs = object("knobs"), options = object("options"), axes = object("axes");
    for (const auto& [name, values] : knobs.items()) {
        KnobAxis axis{name, {}};
        for (const SweepJson& value : read_list(knobs, name.c_str(), place.member("knobs")))
            axis.values.push_back(option_text(value, place.member("knobs." + name)));
        sweep.knobs.push_back(std::move(axis));
    }
    for (const auto& [name, value] : options.items())
        sweep.options[name] = read_option(name, value, file, folder,
                                          place.member("options." + name));
    for (const auto& [name, values] : axes.items()) {
        const SweepPlace at = place.member("axes." + name);
        at.check(!sweep.options.contains(name), "wanted an option that 'options' does not set");
        SweepJson list = SweepJson::array();
        for (const SweepJson& value : read_list(axes, name.c_str(), place.member("axes")))
            list.push_back(read_option(name, value, file, folder, at));
        at.check(std::set<SweepJson>(list.begin(), list.end()).size() == list.size(),
                 "wanted different values, found one twice");
        sweep.axes.emplace_back(name, std::move(list));
    }
    const SweepJson views = object("views"), timing = object("timing");
    check_members(views, {"count", "seed", "cameras-per-instant"}, place.member("views"));
    check_members(timing, {"repeats"}, place.member("timing"));
    sweep.view_count = read_whole_number(views.value("count", SweepJson(1)), 1, kMaxViewCount,
                                         place.member("views.count"));
    sweep.view_seed = read_whole_number(views.value("seed", SweepJson(1)), 0, kMaxSeed,
                                        place.member("views.seed"));
    sweep.cameras_per_instant = read_whole_number(views.value("cameras-per-instant", SweepJson(1)),
                                                  1, kMaxViewCount,
                                                  place.member("views.cameras-per-instant"));
    sweep.timing_repeats = read_whole_number(timing.value("repeats", SweepJson(1)), 0,
                                             kMaxRepeatCount, place.member("timing.repeats"));
    place.member("views").check(sweep.view_count > 1 || views.empty() ||
                                    (views.size() == 1 && views.contains("count")),
                                "wanted a count of at least 6 beside other members");
    if (sweep.view_count > 1) {
        place.check(!sweep.options.contains("seed") && !axes.contains("seed"),
                    "the option 'seed' and 'views': wanted the seed as views.seed");
        sweep.options["seed"] = std::to_string(sweep.view_seed);
    }
    check_piece_count(sweep, place);
    return sweep;
}

/// Returns one set of options for each combination of the axes' values. Options without an axis are
/// in every set. The last axis varies fastest.
std::vector<SweepJson> list_option_sets(const SweepRequest& sweep) {
    std::vector<SweepJson> sets{sweep.options};
    for (const auto& [name, values] : sweep.axes) {
        std::vector<SweepJson> more;
        for (const SweepJson& set : sets)
            for (const SweepJson& value : values) {
                more.push_back(set);
                more.back()[name] = value;
            }
        sets = std::move(more);
    }
    return sets;
}

SweepPiece make_piece(SweepJson content) {
    std::string id = sha256(content.dump());
    return {std::move(id), std::move(content)};
}

void add_pieces(const SweepRequest& sweep, const std::string& scene, const SweepJson& options,
                const fs::path& folder, std::vector<SweepPiece>& pieces) {
    SweepJson content{{"kind", "picture"}, {"scene", scene}, {"options", options}};
    content["techniques"] = sweep.techniques;
    study::CompareRequest request = parse_compare_words(compare_words(content, folder)).request;
    if (!sweep.knobs.empty())
        request.base.techniques = expand_axes(request.base.techniques, sweep.knobs);
    study::check_techniques(request.base.techniques);
    study::check_compare_request(request);
    content["techniques"] = request.base.techniques;
    content["scene_hash"] = scene::hash_scene(request.base.scene);
    content["view"] = nullptr;
    SweepJson timing = content;
    if (sweep.view_count == 1) {
        pieces.push_back(make_piece(content));
    } else {
        std::size_t index = 0;
        for (const measure::View& view :
             study::draw_views(request.base, static_cast<int>(sweep.view_count),
                               static_cast<int>(sweep.cameras_per_instant))) {
            content["view"] = {{"index", ++index}, {"seed", view.seed}, {"time", view.time}};
            pieces.push_back(make_piece(content));
        }
    }
    timing.erase("view");
    timing["kind"] = "timing";
    for (std::int64_t repeat = 1; repeat <= sweep.timing_repeats; ++repeat) {
        timing["repeat"] = repeat;
        pieces.push_back(make_piece(timing));
    }
}

/// Returns the index of the first picture piece for each scene and each device that the options
/// name.
std::vector<std::size_t> common_pieces(const std::vector<SweepPiece>& pieces) {
    std::vector<std::size_t> common;
    std::set<SweepJson> known;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (!pieces[i].is_timing() &&
            known
                .insert(SweepJson::array(
                    {pieces[i].content["scene"], device_options(pieces[i].content)}))
                .second)
            common.push_back(i);
    return common;
}

/// Throws `bad_data` unless a piece of a plan has all members.
void check_piece_members(const SweepJson& content, const SweepPlace& place) {
    place.check(content.is_object(), "wanted a piece, found ", describe(content));
    const auto member = [&](const char* name) { return content.value(name, SweepJson()); };
    const auto require = [&](const char* name, bool fits, const char* wanted) {
        place.member(name).check(fits, "wanted ", wanted, ", found ", describe(member(name)));
    };
    const auto is_text = [](const SweepJson& value) { return value.is_string(); };
    const bool is_timing = member("kind") == "timing";
    require("kind", is_timing || member("kind") == "picture", "picture or timing");
    for (const char* name : {"scene", "scene_hash"})
        require(name, member(name).is_string(), "text");
    const SweepJson techniques = member("techniques"), options = member("options");
    require("techniques",
            techniques.is_array() && !techniques.empty() &&
                std::ranges::all_of(techniques, is_text),
            "a list of techniques");
    require("options", options.is_object(), "an object");
    for (const auto& [name, value] : options.items())
        place.member("options." + name)
            .check(value == true || value.is_string() ||
                       (value.is_array() && std::ranges::all_of(value, is_text)),
                   "wanted true, text or a list of texts, found ", describe(value));
    if (is_timing)
        return require("repeat", member("repeat").is_number_unsigned(), "the number of a repeat");
    const SweepJson view = member("view");
    const bool is_view = view.is_object() &&
                         view.value("index", SweepJson()).is_number_unsigned() &&
                         view.value("seed", SweepJson()).is_number_unsigned() &&
                         view.value("time", SweepJson()).is_number();
    require("view", content.contains("view") && (view.is_null() || is_view),
            "null, or a view with index, seed and time");
}

std::vector<SweepPiece> read_pieces(const SweepJson& list, const SweepPlace& place) {
    place.check(list.is_array() && !list.empty(), "wanted a list that is not empty, found ",
                describe(list));
    std::vector<SweepPiece> pieces;
    for (std::size_t i = 0; i < list.size(); ++i) {
        const SweepPlace at{fmt::format("{}[{}]", place.text, i)};
        at.check(list[i].is_object(), "wanted an object, found ", describe(list[i]));
        SweepJson content = list[i].value("piece", SweepJson());
        const SweepJson id = list[i].value("id", SweepJson());
        check_piece_members(content, at.member("piece"));
        at.member("id").check(id.is_string(), "wanted text, found ", describe(id));
        pieces.push_back(make_piece(std::move(content)));
        at.check(id == pieces.back().id, "was changed: wanted the id of its content, ",
                 pieces.back().id, ", found ", describe(id));
    }
    return pieces;
}

/// Returns the indices of common pieces in a plan's file.
std::vector<std::size_t> read_common_pieces(const SweepJson& list,
                                            const std::vector<SweepPiece>& pieces,
                                            const SweepPlace& place) {
    place.check(list.is_array(), "wanted a list, found ", describe(list));
    std::vector<std::size_t> common;
    for (const SweepJson& index : list) {
        place.check(index.is_number_unsigned() && index < pieces.size() &&
                        !pieces[index.get<std::size_t>()].is_timing(),
                    "wanted numbers of picture pieces, found ", describe(index));
        common.push_back(index.get<std::size_t>());
    }
    return common;
}

fs::path find_plan_file(const fs::path& folder) { return folder / "plan.json"; }

} // namespace

std::string sha256(const std::string& text) {
    sha256_ctx state;
    sha256_init(&state);
    sha256_update(&state, text.size(), reinterpret_cast<const std::uint8_t*>(text.data()));
    std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest{};
    sha256_digest(&state, digest.size(), digest.data());
    return fmt::format("{:02x}", fmt::join(digest, ""));
}

SweepJson device_options(const SweepJson& content) {
    const SweepJson& options = content.at("options");
    return SweepJson::array(
        {options.value("device", SweepJson()), options.value("device-profile", SweepJson())});
}

std::vector<std::string> compare_words(const SweepJson& content, const fs::path& folder) {
    const auto scene = content.at("scene").get<std::string>();
    std::vector<std::string> words{is_built_in(scene) ? scene : path_from_cwd(scene, folder),
                                   "--quiet"};
    for (const auto& [name, value] : content.at("options").items()) {
        const SweepJson list = value.is_array() ? value : SweepJson::array({value});
        for (const SweepJson& entry : list) {
            if (entry.is_boolean()) {
                words.push_back("--" + name);
                continue;
            }
            auto text = entry.get<std::string>();
            if (is_path_option(name, text)) text = path_from_cwd(text, folder);
            words.push_back(fmt::format("--{}={}", name, text));
        }
    }
    if (content.at("techniques").empty()) return words;
    words.emplace_back("--techniques");
    for (const SweepJson& technique : content.at("techniques"))
        words.push_back(technique.get<std::string>());
    return words;
}

SweepPlan make_plan(const fs::path& file, const fs::path& folder) {
    const std::string text = read_json_text(file, "a sweep", kMaxSweepFileBytes);
    const SweepRequest sweep = read_request(parse_json<SweepJson>(file.string(), text), file,
                                            folder);
    SweepPlan plan{nlohmann::ordered_json::parse(text), {}, {}};
    const std::vector<SweepJson> option_sets = list_option_sets(sweep);
    for (const std::string& scene : sweep.scenes)
        for (const SweepJson& options : option_sets) try {
                add_pieces(sweep, scene, options, folder, plan.pieces);
            } catch (const Error& error) {
                throw_error(error.failure, file.string() + ": scene " + quote(scene) +
                                               ", options " + options.dump() + ": " + error.what());
            }
    std::set<std::string> ids;
    for (const SweepPiece& piece : plan.pieces)
        check(ids.insert(piece.id).second, Failure::bad_data, file.string(),
              ": wanted different scenes, found ", quote(piece.content["scene"].get<std::string>()),
              " twice");
    plan.common = common_pieces(plan.pieces);
    return plan;
}

void write_plan(const SweepPlan& plan, const fs::path& folder) {
    nlohmann::ordered_json document{{"schema", "catoptric/sweep-plan/1"}, {"sweep", plan.sweep}};
    document["common"] = plan.common;
    document["pieces"] = nlohmann::ordered_json::array();
    for (const SweepPiece& piece : plan.pieces)
        document["pieces"].push_back({{"id", piece.id}, {"piece", piece.content}});
    const fs::path file = find_plan_file(folder);
    const std::string text = document.dump(1) + "\n";
    std::error_code ignored;
    check(!fs::exists(file, ignored) || read_file(file) == text, Failure::usage, file.string(),
          ": wanted a folder without a plan, found the plan of another sweep");
    write_file(file, text);
}

SweepPlan read_plan(const fs::path& folder) {
    const fs::path file = find_plan_file(folder);
    const std::string text = read_json_text(file, "the plan of a sweep", kMaxPlanBytes);
    const auto document = parse_json<SweepJson>(file.string(), text);
    const SweepPlace place{file.string()};
    place.check(document.is_object(), "wanted an object, found ", describe(document));
    const auto member = [&](const char* name) { return document.value(name, SweepJson()); };
    place.member("schema").check(member("schema") == "catoptric/sweep-plan/1",
                                 "wanted catoptric/sweep-plan/1, found ",
                                 describe(member("schema")));
    place.member("sweep").check(member("sweep").is_object(), "wanted an object, found ",
                                describe(member("sweep")));
    SweepPlan plan;
    plan.sweep = nlohmann::ordered_json::parse(text).at("sweep"); // its members keep their order
    plan.pieces = read_pieces(member("pieces"), place.member("pieces"));
    plan.common = read_common_pieces(member("common"), plan.pieces, place.member("common"));
    return plan;
}

fs::path result_file(const fs::path& folder, const std::string& id) {
    return folder / "results" / (id + ".json");
}

void check_result(const SweepJson& result, const SweepPiece& piece, const std::string& place) {
    const auto require = [&](bool ok, const std::string& what) {
        check(ok, Failure::bad_data, place, ": wanted the result of piece ", piece.id, " with ",
              what, ", found another document");
    };
    const auto is_number = [](const SweepJson& value) {
        return value.is_number() || value.is_null();
    };
    require(result.is_object() && result.value("schema", SweepJson()) == kResultSchema,
            "the schema " + std::string(kResultSchema));
    require(result.value("piece", SweepJson()) == piece.content, "its content");
    const SweepJson identity = result.value("identity", SweepJson()),
                    rows = result.value("rows", SweepJson());
    require(identity.is_object() && identity.value("device", SweepJson()).is_string(),
            "an identity");
    require(rows.is_array() && rows.size() == piece.content["techniques"].size(),
            "a row for each technique");
    require(!piece.is_timing() || result.value("machine", SweepJson()).is_string(), "a machine");
    require(!piece.is_timing() || result.value("date", SweepJson()).is_string(),
            "a date (results of earlier versions lack it: delete them and run again)");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const SweepJson& row = rows[i];
        const std::string what = "rows[" + std::to_string(i) + "]: ";
        require(row.is_object() &&
                    row.value("label", SweepJson()) == piece.content["techniques"][i],
                what + "the label of its technique");
        if (piece.is_timing()) {
            const SweepJson rounds = row.value("rounds", SweepJson());
            require(rounds.is_array() && !rounds.empty() &&
                        std::ranges::all_of(
                            rounds, [](const SweepJson& round) { return round.is_number(); }) &&
                        is_number(row.value("ms", SweepJson("none"))) &&
                        row.value("noisy", SweepJson()).is_boolean(),
                    what + "times");
            continue;
        }
        const SweepJson error = row.value("error", SweepJson());
        require(error.is_object(), what + "errors");
        for (const std::string& metric : sweep_metrics())
            require(error.contains(metric) && is_number(error[metric]),
                    what + "a number or null as " + metric);
    }
}

std::vector<std::string> sweep_metrics() {
    std::vector<std::string> names;
    for (const measure::Metric& metric : measure::difference_metrics()) {
        const bool is_count = metric.name == "pixels" || metric.name == "nonfinite";
        // Without an error, the signal-to-noise ratio (psnr) is infinite, and otherwise it follows
        // from the rmse. Therefore it is not merged.
        if (!is_count && metric.name != "psnr" && measure::is_scalar(metric))
            names.emplace_back(metric.name);
    }
    return names;
}

std::optional<SweepJson> read_result(const fs::path& folder, const SweepPiece& piece) {
    const fs::path file = result_file(folder, piece.id);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    auto result = parse_json<SweepJson>(
        file.string(), read_json_text(file, "the result of a piece", kMaxResultBytes));
    check_result(result, piece, file.string());
    return result;
}

} // namespace catoptric::cli
