// Tests of verdicts on drawn tables of rows: noise alone gives no victory, verdicts do not
// contradict each other, and the order of the rows does not matter.
#include "measure/budget.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"
#include "report/plot.hpp"
#include "report/tables.hpp"
#include "unit/report_sample.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <regex>
#include <set>

namespace {

using namespace catoptric;
using measure::Order;
using report::Comparison;
using report::Row;
using testing::HasSubstr;
using testing::Not;

constexpr int kRoundsOfDrawnRows = 6;

/// Sets a row's time to rounds of one frame each.
void set_rounds(Row& row, const std::vector<double>& rounds) {
    std::vector<std::vector<double>> frames;
    for (const double round : rounds) frames.push_back({round});
    row.gpu_ms = measure::summarise(frames);
}

/// Draws rows whose times vary by normal noise, and whose true times and errors are given by
/// `true_ms` and `flip` for the number of the row. Every second row is ray traced.
template <class Time, class Flip>
Comparison draw_table(std::mt19937_64& random, std::size_t count, double deviation, Time&& true_ms,
                      Flip&& flip) {
    std::normal_distribution<double> noise(1, deviation);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string number = std::to_string(i);
        rows.push_back(report::sample::make_row(
            (i % 2 == 0 ? "raytrace:depth=" : "reuse:face=") + number, 1, .1, flip(i)));
        std::vector<double> rounds;
        for (int round = 0; round < kRoundsOfDrawnRows; ++round)
            rounds.push_back(true_ms(i) * std::max(noise(random), .01));
        set_rounds(rows.back(), rounds);
    }
    Comparison made = report::sample::make_comparison(std::move(rows));
    made.pareto = measure::find_pareto_front(made.rows);
    return made;
}

/// Returns the pairs of rows of which the first beats the second.
std::vector<std::pair<std::size_t, std::size_t>> list_victories(const Comparison& made) {
    const measure::RowJudge judge(made.rows);
    std::vector<std::pair<std::size_t, std::size_t>> list;
    for (std::size_t a = 0; a < made.rows.size(); ++a)
        for (std::size_t b = 0; b < made.rows.size(); ++b)
            if (judge.beats(made.rows[a], made.rows[b])) list.emplace_back(a, b);
    return list;
}

/// Rows that take the same time and err equally. A victory in one table of twenty is what 95 %
/// confidence allows.
TEST(Verdict, NoiseAloneGivesAVictoryInAtMostOneTableOfTwenty) {
    std::mt19937_64 random(1);
    constexpr int kTables = 2000;
    for (const std::size_t count : {2, 3, 6, 22})
        for (const double deviation : {.002, .03, .1, .3}) {
            int victories = 0, fastest = 0;
            for (int table = 0; table < kTables / (count > 6 ? 10 : 1); ++table) {
                const Comparison made = draw_table(
                    random, count, deviation, [](std::size_t) { return 10.; },
                    [](std::size_t i) { return .1 + .0001 * static_cast<double>(i % 3); });
                victories += !list_victories(made).empty();
                fastest += measure::find_fastest_rows(made).rows.size() == 1;
            }
            const double tables = kTables / (count > 6 ? 10. : 1.);
            EXPECT_LE(victories / tables, .05) << count << " rows, deviation " << deviation;
            EXPECT_LE(fastest / tables, .05) << count << " rows, deviation " << deviation;
        }
}

/// One slow row shows that times differ. The other rows take the same time, and each pair of them
/// gets a wrong verdict with a probability of 5 % at most.
TEST(Verdict, PairsOfEqualRowsBesideASlowRowGetFewWrongVerdicts) {
    std::mt19937_64 random(2);
    double wrong = 0, pairs = 0;
    for (int table = 0; table < 300; ++table) {
        const Comparison made = draw_table(
            random, 10, .1, [](std::size_t i) { return i == 0 ? 100. : 10.; },
            [](std::size_t) { return .1; });
        for (const auto& [a, b] : list_victories(made)) wrong += b != 0;
        pairs += 9 * 8 / 2;
    }
    EXPECT_LE(wrong / pairs, .05);
    EXPECT_GT(wrong, 0) << "the test must be able to fail";
}

TEST(Verdict, RowsThatAreShownEqualTie) {
    std::mt19937_64 random(3);
    const Comparison made = draw_table(
        random, 6, .002, [](std::size_t) { return 10.; }, [](std::size_t) { return .1; });
    EXPECT_EQ(made.pareto.size(), made.rows.size());
    EXPECT_TRUE(measure::find_fastest_rows(made).are_equal);
    EXPECT_TRUE(measure::rank_rows(made).open.empty());
    EXPECT_EQ(measure::find_ray_tracing_verdict(made).unbeaten.size(), 3u);
    EXPECT_THAT(report::summarise_verdict(made),
                HasSubstr("no ray-traced row beats any other row"));
}

TEST(Verdict, WideIntervalsGiveNoVerdict) {
    std::mt19937_64 random(4);
    Comparison made = draw_table(
        random, 6, .3, [](std::size_t) { return 10.; }, [](std::size_t) { return .1; });
    EXPECT_EQ(measure::rank_rows(made).open.size(), 6u);
    EXPECT_EQ(report::summarise_verdict(made),
              "On this device, Card, cannot tell whether ray tracing beats another row: 6 of 6 "
              "rows may be fastest.");
    std::erase_if(made.rows, [](const Row& row) { return row.technique == "raytrace"; });
    made.pareto = measure::find_pareto_front(made.rows);
    EXPECT_THAT(report::summarise_verdict(made),
                HasSubstr("On this device, Card, cannot tell: 3 of 3 rows may be fastest, closest "
                          "is "));
}

/// A row that is closer does not beat a row whose time may be shorter, however many rounds tie.
TEST(Verdict, LessErrorDoesNotBeatATimeThatCannotBeTold) {
    Row closer = report::sample::make_row("raytrace", 10, .1, .01),
        other = report::sample::make_row("planar", 10, .1, .2);
    set_rounds(closer, {9, 11, 9, 11, 9, 11});
    set_rounds(other, {11, 9, 11, 9, 11, 9});
    const measure::RowJudge judge({closer, other});
    EXPECT_FALSE(judge.beats(closer, other));
    EXPECT_TRUE(judge.is_open(closer, other));
    EXPECT_FALSE(judge.is_open(other, closer)) << "it errs more, so it cannot beat";
    const Comparison made = report::sample::make_comparison({closer, other});
    EXPECT_EQ(measure::find_pareto_front(made.rows).size(), 2u);
}

/// Draws tables in which times and errors lie close together, so that rows are equal, better and
/// unknown in all combinations.
Comparison draw_close_table(std::mt19937_64& random) {
    std::uniform_real_distribution<double> ms(9, 11), flip(.09, .11);
    const double deviations[] = {0, .005, .02, .05};
    return draw_table(
        random, 12, deviations[random() % 4], [&](std::size_t) { return ms(random); },
        [&](std::size_t) { return flip(random); });
}

/// Removes rows that no other row beats, until none is left. Returns whether rows were left over,
/// which then beat each other in a circle.
bool has_circle(const Comparison& made) {
    const auto victories = list_victories(made);
    std::set<std::size_t> left;
    for (std::size_t i = 0; i < made.rows.size(); ++i) left.insert(i);
    for (bool changed = true; changed;) {
        changed = false;
        for (const std::size_t row : std::set(left))
            if (std::ranges::none_of(victories, [&](const auto& pair) {
                    return pair.second == row && left.contains(pair.first);
                }))
                left.erase(row), changed = true;
    }
    return !left.empty();
}

TEST(Verdict, VerdictsDoNotContradictEachOther) {
    std::mt19937_64 random(5);
    for (int table = 0; table < 500; ++table) {
        const Comparison made = draw_close_table(random);
        const auto victories = list_victories(made);
        for (const auto& [a, b] : victories)
            EXPECT_EQ(std::ranges::count(victories, std::pair(b, a)), 0) << a << " and " << b;
        EXPECT_FALSE(has_circle(made));
        ASSERT_FALSE(made.pareto.empty());
        for (std::size_t i = 0; i < made.rows.size(); ++i)
            EXPECT_EQ(
                std::ranges::count(made.pareto, i) == 0,
                std::ranges::any_of(victories, [&](const auto& pair) { return pair.second == i; }));
        // A row that is beaten, unbeaten or open is in one list alone.
        const measure::RayTracingVerdict verdict = measure::find_ray_tracing_verdict(made);
        EXPECT_EQ(verdict.others(), 6u);
        for (const Row* row : verdict.beaten) EXPECT_FALSE(measure::is_on_front(made, *row));
    }
}

TEST(Verdict, ARowThatIsBetterStillBeats) {
    std::mt19937_64 random(6);
    for (int table = 0; table < 100; ++table) {
        const Comparison made = draw_close_table(random);
        for (const auto& [a, b] : list_victories(made)) {
            Comparison better = made;
            better.rows[a].error.flip -= .01;
            EXPECT_TRUE(measure::RowJudge(better.rows).beats(better.rows[a], better.rows[b]));
            better = made;
            better.rows[b].error.flip += .01;
            EXPECT_TRUE(measure::RowJudge(better.rows).beats(better.rows[a], better.rows[b]));
            for (const double factor : {.97, .5}) {
                better = made;
                std::vector<double> rounds = made.rows[a].gpu_ms.rounds;
                for (double& round : rounds) round *= factor;
                set_rounds(better.rows[a], rounds);
                const measure::RowJudge judge(better.rows);
                EXPECT_FALSE(judge.beats(better.rows[b], better.rows[a]));
                // Between equal and faster lies a gap in which neither is shown.
                EXPECT_TRUE(judge.beats(better.rows[a], better.rows[b]) ||
                            judge.times(better.rows[a], better.rows[b]) == Order::unknown);
            }
        }
    }
}

/// Returns what a comparison says of its rows, by their labels.
std::multiset<std::string> describe_verdicts(const Comparison& made) {
    std::multiset<std::string> said;
    const auto add = [&](const char* what, const std::vector<const Row*>& rows) {
        for (const Row* row : rows) said.insert(std::string(what) + row->label);
    };
    const measure::RayTracingVerdict verdict = measure::find_ray_tracing_verdict(made);
    add("beaten ", verdict.beaten), add("unbeaten ", verdict.unbeaten), add("open ", verdict.open);
    add("fastest ", measure::find_fastest_rows(made).rows);
    add("front ", measure::rank_rows(made).front);
    add("open front ", measure::rank_rows(made).open);
    for (const Row& row : made.rows) {
        const measure::RankRange place = measure::find_rank_range(made, row);
        said.insert(row.label + " " + std::to_string(place.first) + "-" +
                    std::to_string(place.last));
    }
    return said;
}

TEST(Verdict, OrderOfRowsDoesNotMatter) {
    std::mt19937_64 random(7);
    for (int table = 0; table < 50; ++table) {
        Comparison made = draw_close_table(random);
        const std::multiset<std::string> said = describe_verdicts(made);
        std::ranges::shuffle(made.rows, random);
        made.pareto = measure::find_pareto_front(made.rows);
        EXPECT_EQ(describe_verdicts(made), said);
    }
}

/// The places, the budget and the first sentence name the same rows.
TEST(Verdict, PlacesBudgetAndSentenceAgree) {
    std::mt19937_64 random(8);
    for (int table = 0; table < 100; ++table) {
        Comparison made = draw_close_table(random);
        const measure::FastestRows fastest = measure::find_fastest_rows(made);
        for (const Row& row : made.rows)
            EXPECT_EQ(measure::find_rank_range(made, row).first == 1,
                      std::ranges::count(fastest.rows, &row) == 1)
                << row.label;
        made.max_flip = 1; // every row keeps it, so the answer is the fastest row
        const measure::BestRows answer = measure::find_best_rows(made);
        EXPECT_EQ(std::ranges::count(fastest.rows, answer.row), 1);
        const std::string said = report::describe_budget(made);
        EXPECT_EQ(answer.open.empty(), said.find("cannot tell which of") == said.npos);
        EXPECT_EQ(fastest.rows.size() == 1, answer.open.empty() && answer.equal.empty());
    }
}

/// A row that is judged by processor time: a program beside it made its device times long.
TEST(Verdict, RowsOnAProcessorAreJudgedByProcessorTime) {
    Row a = report::sample::make_row("raytrace", 50, .1, .01),
        b = report::sample::make_row("planar", 10, .1, .2);
    a.cpu_ms = report::sample::make_time_samples(5),
    b.cpu_ms = report::sample::make_time_samples(9);
    Comparison made = report::sample::make_comparison({a, b});
    EXPECT_THAT(report::summarise_verdict(made), HasSubstr("no ray-traced row beats"));
    EXPECT_EQ(measure::judged_time(made), "gpu_ms");
    made.device.type = "cpu";
    for (Row& row : made.rows) row.on_processor = true;
    made.pareto = measure::find_pareto_front(made.rows);
    EXPECT_EQ(made.pareto, std::vector<std::size_t>{0});
    EXPECT_EQ(measure::judged_time(made), "cpu_ms");
    EXPECT_EQ(report::summarise_verdict(made),
              "On this device, Card, by processor time, ray tracing beats every other row, 1 of "
              "1.");
    made.max_ms = 6;
    EXPECT_EQ(report::describe_budget(made),
              "Within 6 ms on Card, by processor time: raytrace (5.00 ms [5.00 - 5.00], FLIP "
              "0.0100) has the least FLIP.");
    EXPECT_THAT(report::comparison_plot(made), HasSubstr("Processor time of a frame"));
    const auto document = nlohmann::json::parse(report::to_json(made));
    EXPECT_EQ(document["judged_time"], "cpu_ms");
    EXPECT_EQ(document["verdict"]["ray_tracing"]["beats"], nlohmann::json({"planar"}));
    EXPECT_EQ(document["verdict"]["text"], report::summarise_verdict(made));
    const std::string text = report::to_markdown(made);
    EXPECT_THAT(text, HasSubstr("rows are judged by processor time of its software driver"));
    made.rows[1].noisy = true;
    EXPECT_THAT(report::to_markdown(made), HasSubstr("their device times are not to be trusted"));
}

std::vector<double> read_numbers(const std::string& text) {
    static const std::regex kNumber(R"(-?[0-9]+\.?[0-9]*)");
    std::vector<double> numbers;
    for (std::sregex_iterator at(text.begin(), text.end(), kNumber), end; at != end; ++at)
        numbers.push_back(std::stod(at->str()));
    return numbers;
}

TEST(Verdict, NoMarkLiesLeftOfTheDrawnFrontAndBelow) {
    std::mt19937_64 random(9);
    for (int table = 0; table < 50; ++table) {
        Comparison made = draw_close_table(random);
        made.rows[0].error.flip = 0;       // in the lane of zeros
        made.rows[1].mirrors_black = true; // not judged
        set_rounds(made.rows[1], std::vector<double>(kRoundsOfDrawnRows, 1));
        made.rows[2].error.flip = made.rows[3].error.flip - .001; // equal, and slower
        set_rounds(made.rows[2], std::vector<double>(kRoundsOfDrawnRows, 20));
        made.pareto = measure::find_pareto_front(made.rows);
        const std::string svg = report::comparison_plot(made);
        EXPECT_THAT(svg, Not(HasSubstr("<title>" + made.rows[1].label + ":")));
        std::smatch path;
        ASSERT_TRUE(std::regex_search(svg, path, std::regex(R"re(class="step" d="([^"]*)")re")));
        // Corners of the staircase: M x top, then pairs of H x and V y, then H right.
        const std::vector<double> steps = read_numbers(path[1]);
        static const std::regex kMark(
            R"re(class="mark[^"]*" (cx|x)="([0-9.]+)" (cy|y)="([0-9.]+)")re");
        std::size_t marks = 0;
        for (std::sregex_iterator at(svg.begin(), svg.end(), kMark), end; at != end; ++at) {
            const double shift = at->str(1) == "x" ? 4.5 : 0; // squares begin at a corner
            const double x = std::stod(at->str(2)) + shift, y = std::stod(at->str(4)) + shift;
            double front = steps.at(1); // height of the front at this time
            for (std::size_t i = 2; i + 1 < steps.size(); i += 2)
                if (steps[i] <= x + .11) front = std::max(front, steps[i + 1]);
            EXPECT_GE(x, steps.at(0) - .11);
            EXPECT_LE(y, front + .11) << "pixels grow downwards";
            ++marks;
        }
        EXPECT_EQ(marks, made.rows.size() - 1);
    }
}

} // namespace
