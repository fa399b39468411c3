#include "sweep_run.hpp"

#include "compare_words.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/text.hpp"
#include "measure/judge.hpp"
#include "measure/views.hpp"
#include "progress.hpp"
#include "report/json.hpp"
#include "report/writer.hpp"
#include "scene/hash.hpp"
#include "session/device_facts.hpp"
#include "session/exposure.hpp"
#include "session/processor.hpp"
#include "session/scene_info.hpp"
#include "session/seeded_camera.hpp"
#include "session/watcher.hpp"
#include "signals.hpp"
#include "study/views.hpp"
#include "sweep_locks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <unistd.h>

namespace catoptric::cli {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShortIdCharacters = 12; // length of ids in messages

std::string read_host_name() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

/// Returns the identity of results: program, driver and processor, which decide the bits of a
/// picture.
SweepJson make_identity(const session::Engine& engine) {
    const measure::DeviceFacts device = session::make_device_facts(engine);
    const bool on_processor = device.type == "cpu";
    return {{"version", session::version()},
            {"commit", session::commit()},
            {"device", device.name},
            {"driver", device.driver},
            {"lanes", device.lanes},
            {"processor", on_processor ? SweepJson(session::read_processor_name()) : SweepJson()}};
}

/// Converts JSON of a report, whose members are in order of writing, to JSON with sorted members.
SweepJson sort_members(const report::Json& json) { return SweepJson::parse(json.dump()); }

std::string describe_piece(const SweepPiece& piece) {
    const SweepJson& content = piece.content;
    const auto scene = content["scene"].get<std::string>();
    const std::string id = piece.id.substr(0, kShortIdCharacters);
    if (piece.is_timing())
        return fmt::format("piece {}: times of {}, repeat {}", id, scene,
                           content["repeat"].get<int>());
    return content["view"].is_null() ? fmt::format("piece {}: {}", id, scene)
                                     : fmt::format("piece {}: {}, view {}", id, scene,
                                                   content["view"]["index"].get<int>());
}

/// The scene and sessions of the last picture piece. Successive pieces with the same scene and
/// options use them again. If pieces share instants, each row has a session, so that its captures
/// settle once for all successive pieces of an instant. This changes no byte of a picture.
struct SweepScene {
    SweepJson key; ///< the part of a piece's content that does not depend on its view
    study::CompareRequest request;
    std::unique_ptr<session::Session> session;                   ///< of the reference
    std::vector<std::unique_ptr<session::Session>> row_sessions; ///< may be empty
    std::optional<double> instant; ///< for which the captures of all rows have settled
};

class SweepRunner {
public:
    SweepRunner(const fs::path& folder, const SweepPlan& plan, const SweepRunOptions& options)
        : folder_(folder), plan_(plan), options_(options), locks_(folder / "locks"),
          progress_(options.output_options, ProgressPrinter::OffTerminal::tenths) {
        watcher_.stop = &stop_on_signals();
    }

    SweepRunCounts run_all() {
        const std::vector<std::size_t> places = pieces_to_run();
        SweepRunCounts counts;
        std::optional<Error> first_failure;
        std::size_t failures = 0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            const SweepPiece& piece = plan_.pieces[places[i]];
            throw_if_stopped(watcher_);
            try {
                run_piece(piece, places[i], places.size() - i, counts);
            } catch (const Error& error) {
                const std::string what = describe_piece(piece) + ": " + error.what();
                if (is_fatal(error.failure) || places.size() == 1) throw_error(error.failure, what);
                progress_.clear();
                print_message(what);
                if (!first_failure) first_failure = Error(error.failure, what);
                ++failures;
            }
        }
        progress_.clear();
        if (engine_ && is_validated_) engine_->check_validation();
        if (first_failure)
            throw_error(first_failure->failure,
                        fmt::format("{} of {} pieces failed; the first: {}", failures,
                                    places.size(), first_failure->what()));
        return counts;
    }

private:
    /// Returns whether a failure, such as a missing device, would also make all further pieces
    /// fail.
    static bool is_fatal(Failure failure) {
        return is_signal(failure) || failure == Failure::device_lost ||
               failure == Failure::no_device || failure == Failure::cannot_create ||
               failure == Failure::io || failure == Failure::internal;
    }

    /// Returns the indices of the pieces to run: first picture pieces, then timing pieces, each in
    /// the order of the plan.
    std::vector<std::size_t> pieces_to_run() const {
        using PieceKinds = SweepRunOptions::PieceKinds;
        const std::vector<std::string> ids = full_ids();
        std::vector<std::size_t> places;
        for (const bool timing : {false, true}) {
            if (options_.kinds == (timing ? PieceKinds::pictures : PieceKinds::timings)) continue;
            for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
                if (plan_.pieces[i].is_timing() == timing &&
                    (ids.empty() || std::ranges::find(ids, plan_.pieces[i].id) != ids.end()))
                    places.push_back(i);
        }
        return places;
    }

    /// Returns the full ids of the pieces that the user named. A name may be the beginning of an
    /// id, as messages show it.
    std::vector<std::string> full_ids() const {
        std::vector<std::string> ids;
        for (const std::string& name : options_.pieces) {
            std::size_t found = 0;
            for (const SweepPiece& piece : plan_.pieces)
                if (name.size() >= kShortIdCharacters && piece.id.starts_with(name)) {
                    ids.push_back(piece.id);
                    ++found;
                }
            check(found == 1, Failure::usage, "--piece: wanted the id of a piece in ",
                  (folder_ / "plan.json").string(), ", or its first ", kShortIdCharacters,
                  " characters, found ", quote(name));
        }
        return ids;
    }

    /// `left`: number of pieces from this piece on. Some of them may already be finished.
    void run_piece(const SweepPiece& piece, std::size_t place, std::size_t left,
                   SweepRunCounts& counts) {
        if (read_result(folder_, piece)) {
            ++counts.finished_before;
            return;
        }
        while (!locks_.try_lock(place)) {
            if (options_.pieces.empty()) {
                ++counts.elsewhere;
                return;
            }
            wait_for_others();
        }
        try {
            if (read_result(folder_, piece)) { // another process finished the piece while
                                               // this process waited
                ++counts.finished_before;
            } else {
                progress_.row(describe_piece(piece), counts.run, counts.run + left);
                progress_.frame(0, 1);
                print_detail(options_.output_options, "begun: " + piece.id);
                write_result(piece,
                             piece.is_timing() ? measure_times(piece) : measure_errors(piece));
                ++counts.run;
            }
        } catch (...) {
            locks_.unlock(place);
            throw;
        }
        locks_.unlock(place);
    }

    void wait_for_others() const {
        throw_if_stopped(watcher_);
        constexpr useconds_t kPollMicroseconds = 50'000;
        ::usleep(kPollMicroseconds);
    }

    void write_result(const SweepPiece& piece, SweepJson result) const {
        result["schema"] = kResultSchema;
        result["piece"] = piece.content;
        result["identity"] = identity_;
        check_result(result, piece, "this program");
        write_file(result_file(folder_, piece.id), result.dump(1) + "\n");
    }

    /// Returns the engine for a piece's device. The engine of the last piece is used again if its
    /// device is the same.
    session::Engine& prepare_engine(const DeviceOptions& device) {
        const SweepJson key{device.name, device.profile, device.validate};
        if (engine_ && key == engine_key_) return *engine_;
        scene_ = {};
        if (engine_ && is_validated_) engine_->check_validation();
        engine_.reset();
        engine_ = std::make_unique<session::Engine>(engine_options(device));
        engine_key_ = key;
        is_validated_ = device.validate;
        print_device(*engine_, options_.output_options);
        identity_ = make_identity(*engine_);
        has_drawn_common_ = false;
        return *engine_;
    }

    static void check_scene(const SweepPiece& piece, const scene::Scene& scene) {
        const std::string found = scene::hash_scene(scene),
                          wanted = piece.content["scene_hash"].get<std::string>();
        check(found == wanted, Failure::bad_data,
              "the scene was changed after the sweep was planned: wanted the hash ", wanted,
              ", found ", found);
    }

    /// Returns whether another piece differs from this piece in its camera alone.
    bool shares_instant(const SweepPiece& piece) const {
        if (piece.content["view"].is_null()) return false;
        SweepJson key = piece.content;
        key.erase("view");
        return std::ranges::any_of(plan_.pieces, [&](const SweepPiece& other) {
            if (other.id == piece.id || other.is_timing() || !other.content["view"].is_object() ||
                other.content["view"]["time"] != piece.content["view"]["time"])
                return false;
            SweepJson other_key = other.content;
            other_key.erase("view");
            return other_key == key;
        });
    }

    SweepScene& open_scene(const SweepPiece& piece) {
        SweepJson key = piece.content;
        key.erase("view");
        if (scene_.session && scene_.key == key) return scene_;
        CompareWords words = parse_compare_words(compare_words(key, folder_));
        check_scene(piece, words.request.base.scene);
        session::Engine& engine = prepare_engine(words.device);
        scene_ = {}; // frees the last scene's memory; stays empty on failure
        SweepScene scene{key, std::move(words.request), nullptr};
        scene.session = std::make_unique<session::Session>(engine, scene.request.base.scene);
        session::resolve_exposure(*scene.session, scene.request.base);
        if (shares_instant(piece))
            for (std::size_t i = 0; i < scene.request.base.techniques.size(); ++i)
                scene.row_sessions.push_back(
                    std::make_unique<session::Session>(engine, scene.request.base.scene));
        scene_ = std::move(scene);
        return scene_;
    }

    /// Returns the view of a piece: a view drawn from the piece's seed, or the view of the options.
    static measure::View make_view(const SweepJson& view, const session::Request& base) {
        if (view.is_null())
            return {session::make_camera_facts(base.camera, base.time), base.time, base.seed};
        const auto seed = view["seed"].get<std::uint64_t>();
        const auto time = view["time"].get<double>();
        return {
            session::make_camera_facts(session::make_seeded_camera(base.scene, time, seed), time),
            time, seed};
    }

    /// Returns a row for each technique, with its errors in the piece's view. For a common piece,
    /// also writes the pictures.
    report::Comparison compute_errors(const SweepPiece& piece) {
        SweepScene& scene = open_scene(piece);
        report::Comparison comparison;
        comparison.views = {make_view(piece.content["view"], scene.request.base)};
        for (const std::string& text : scene.request.base.techniques)
            comparison.rows.emplace_back().label = text;
        std::vector<session::Session*> row_sessions;
        for (const auto& session : scene.row_sessions) row_sessions.push_back(session.get());
        const double instant = comparison.views.front().time;
        const bool continues = !row_sessions.empty() &&
                               std::exchange(scene.instant, std::nullopt) == instant;
        study::measure_views(*scene.session,
                             {.base = scene.request.base,
                              .reference = scene.request.reference,
                              .watcher = {.stop = watcher_.stop},
                              .row_sessions = std::move(row_sessions),
                              .continues_instant = continues},
                             comparison);
        scene.instant = instant; // not after an exception, which leaves rows unfinished
        if (is_common(piece)) write_common_pictures(piece, comparison);
        return comparison;
    }

    /// Draws the pictures of common pieces that no machine of this identity has drawn yet. Each
    /// result then has common pictures of the same identity.
    void draw_common_pictures() {
        if (has_drawn_common_) return;
        has_drawn_common_ = true;
        const SweepJson device = device_options(scene_.key);
        for (const std::size_t place : plan_.common) {
            const SweepPiece& piece = plan_.pieces[place];
            if (has_common_pictures(piece) || device_options(piece.content) != device) continue;
            try {
                compute_errors(piece);
            } catch (const Error& error) {
                if (is_fatal(error.failure)) throw;
                print_detail(options_.output_options,
                             describe_piece(piece) + ": no common pictures: " + error.what());
            }
        }
    }

    SweepJson measure_errors(const SweepPiece& piece) {
        const MachineLock lock(MachineLock::Use::shared, *watcher_.stop);
        open_scene(piece);
        if (!is_common(piece)) draw_common_pictures();
        const report::Comparison comparison = compute_errors(piece);
        report::Json rows = report::Json::array();
        for (const report::Row& row : comparison.rows) {
            report::Json json{{"label", row.label}};
            report::add_errors(json, row.views.front());
            rows.push_back(json);
        }
        return {{"rows", sort_members(rows)}};
    }

    SweepJson measure_times(const SweepPiece& piece) {
        const MachineLock lock(MachineLock::Use::alone, *watcher_.stop);
        CompareWords words = parse_compare_words(compare_words(piece.content, folder_));
        check_scene(piece, words.request.base.scene);
        session::Engine& engine = prepare_engine(words.device);
        words.request.watcher = {.stop = watcher_.stop};
        words.request.reference_seconds = 0;
        const report::Comparison comparison = study::compare(engine, words.request);
        if (comparison.stopped)
            throw_error(comparison.stopped->failure, comparison.stopped->what());
        report::Json rows = report::Json::array();
        for (const report::Row& row : comparison.rows) {
            const measure::SampleSummary& times = row.time_ms();
            rows.push_back({{"label", row.label},
                            {"ms", report::number_json(times.median)},
                            {"ci95", report::interval_json(times.ci95)},
                            {"rounds", report::numbers_json(times.rounds)},
                            {"waited", report::number_json(row.waited)},
                            {"noisy", row.noisy},
                            {"ranked", measure::is_rankable(row)}});
        }
        return {{"rows", sort_members(rows)},
                {"machine", read_host_name()},
                {"date", comparison.date},
                {"load",
                 sort_members(report::numbers_json({comparison.load_start, comparison.load_end}))}};
    }

    bool is_common(const SweepPiece& piece) const {
        return std::ranges::any_of(
            plan_.common, [&](std::size_t place) { return plan_.pieces[place].id == piece.id; });
    }

    bool has_common_pictures(const SweepPiece& piece) const {
        std::error_code ignored;
        return fs::exists(common_folder(folder_, identity_, piece.id) / kCommonListFile, ignored);
    }

    /// Writes the picture of each row, and then the list of pictures. Processes of one identity
    /// would write the same files, so only one process may write at a time.
    void write_common_pictures(const SweepPiece& piece,
                               const report::Comparison& comparison) const {
        const std::size_t place = plan_.pieces.size() +
                                  static_cast<std::size_t>(&piece - plan_.pieces.data());
        while (!locks_.try_lock(place)) wait_for_others();
        try {
            if (!has_common_pictures(piece)) write_picture_files(piece, comparison);
        } catch (...) {
            locks_.unlock(place);
            throw;
        }
        locks_.unlock(place);
    }

    void write_picture_files(const SweepPiece& piece, const report::Comparison& comparison) const {
        const fs::path folder = common_folder(folder_, identity_, piece.id);
        report::create_folder(folder);
        write_file(folder.parent_path() / "identity.json", identity_.dump(1) + "\n");
        SweepJson names = SweepJson::array();
        for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
            const auto& worst = comparison.rows[i].worst;
            if (!worst) continue; // the view shows no mirror, so it has no error
            names.push_back(fmt::format("{}.png", i));
            measure::write_png(worst->display, folder / names.back().get<std::string>());
        }
        write_file(folder / kCommonListFile, names.dump() + "\n");
    }

    fs::path folder_;
    const SweepPlan& plan_;
    const SweepRunOptions& options_;
    PieceLockFile locks_;
    ProgressPrinter progress_;
    session::Watcher watcher_;
    std::unique_ptr<session::Engine> engine_;
    SweepJson engine_key_;
    SweepJson identity_;            ///< identity of the engine
    bool has_drawn_common_ = false; ///< whether this process tried to draw the pictures
                                    ///< for this engine
    bool is_validated_ = false;     ///< whether the engine reports validation messages
    SweepScene scene_;              ///< destroyed before the engine
};

} // namespace

fs::path common_folder(const fs::path& folder, const SweepJson& identity,
                       const std::string& piece_id) {
    return folder / "common" / sha256(identity.dump()).substr(0, 12) / piece_id;
}

SweepRunCounts run_pieces(const fs::path& folder, const SweepPlan& plan,
                          const SweepRunOptions& options) {
    report::create_folder(folder / "results");
    return SweepRunner(folder, plan, options).run_all();
}

} // namespace catoptric::cli
