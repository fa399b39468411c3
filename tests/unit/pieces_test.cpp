// Tests of require::face_part_containing, which returns a rectangle of a capture's face that holds
// a moving object.
#include "core/shader_math.hpp"
#include "require/pieces.hpp"
#include "support/numbers.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;
using namespace catoptric::require;

/// Returns the coordinates at which a face shows a point in front of the face: right and down, from
/// -1 to 1.
dvec2 face_coordinates_of_point(int face, const dvec3& place) {
    const dvec3 coordinates = f64::cube_coordinates(face, place);
    return dvec2(coordinates) / coordinates.z;
}

bool does_face_part_hold_place(const FacePart& part, const dvec2& at) {
    return all(lessThanEqual(part.low, at + 1e-12)) && all(lessThanEqual(at, part.high + 1e-12));
}

TEST(Pieces, FacePartOfABoxInFrontSpansItsCorners) {
    // Face +X has -Z on its right and -Y below. The box lies 2 to 4 in front of the centre, and its
    // near side looks larger than its far side.
    const FacePart part = face_part_containing(0, {{2, -.5, .2}, {4, .5, 1}});
    EXPECT_EQ(part.low, dvec2(-.5, -.25));
    EXPECT_EQ(part.high, dvec2(-.05, .25));
    // A box that reaches beyond the edge of the face gives a rectangle that ends at the edge.
    EXPECT_EQ(face_part_containing(0, {{2, -.5, .2}, {4, .5, 3}}).low, dvec2(-1, -.25));
    // The rectangle of two boxes holds their hull, so also the space between the boxes.
    const FacePart both = face_part_containing(0, {{2, -.5, .2}, {4, .5, 1}},
                                               {{2, 1, -1}, {2, 1, -1}});
    EXPECT_EQ(both.low, dvec2(-.5, -.5));
    EXPECT_EQ(both.high, dvec2(.5, .25));
}

TEST(Pieces, FacePartIsEmptyForABoxElsewhereAndWholeForABoxAround) {
    const Bounds<double> right{{2, -.5, -.5}, {4, .5, .5}};
    for (int face = 1; face < 6; ++face)
        EXPECT_TRUE(face_part_containing(face, right).is_empty()) << face;
    for (int face = 0; face < 6; ++face)
        EXPECT_TRUE(face_part_containing(face, {dvec3(-1), dvec3(2)}).is_whole()) << face;
    // A floor that passes below the centre covers the whole width of the face, from below the
    // horizon to the lower edge.
    const FacePart floor = face_part_containing(0, {{-3, -1.5, -9}, {6, -1, 9}});
    EXPECT_EQ(floor.low, dvec2(-1, 1 / 6.));
    EXPECT_EQ(floor.high, dvec2(1));
}

TEST(Pieces, FacePartHoldsEveryPointOfABoxAndOfAHull) {
    test::RandomNumbers numbers(7);
    const auto place = [&](double size) {
        return size * dvec3(numbers.random_number_between(-1, 1),
                            numbers.random_number_between(-1, 1),
                            numbers.random_number_between(-1, 1));
    };
    int inside = 0, partly = 0;
    for (int k = 0; k < 400; ++k) {
        std::array<Bounds<double>, 2> boxes;
        for (Bounds<double>& box : boxes) {
            const dvec3 middle = place(3), half = abs(place(1.5));
            box = {middle - half, middle + half};
        }
        for (int face = 0; face < 6; ++face) {
            const FacePart one = face_part_containing(face, boxes[0]),
                           both = face_part_containing(face, boxes[0], boxes[1]);
            partly += !one.is_empty() && !one.is_whole() ? 1 : 0;
            for (int i = 0; i < 40; ++i) {
                std::array<dvec3, 2> at;
                for (std::size_t box = 0; box < 2; ++box)
                    at[box] = mix(boxes[box].lo, boxes[box].hi, place(.5) + .5);
                const dvec3 between = mix(at[0], at[1], numbers.random_number_between(0, 1));
                for (const auto& [where, part] : {std::pair(at[0], one), {between, both}}) {
                    if (f64::cube_face(where) != face) continue;
                    ++inside;
                    EXPECT_TRUE(
                        does_face_part_hold_place(part, face_coordinates_of_point(face, where)))
                        << k << ", face " << face;
                }
            }
        }
    }
    EXPECT_GT(inside, 20000);
    EXPECT_GT(partly, 400);
}

TEST(Pieces, DifferingPartHoldsPiecesOfOnlyOneState) {
    const FacePart a{dvec2(-1), dvec2(-.5)}, b{dvec2(0), dvec2(.25)}, c{dvec2(.5), dvec2(.75)};
    const auto states = [](std::vector<MovingPart> before, std::vector<MovingPart> after) {
        MovingParts old, now;
        old.faces[2] = std::move(before), now.faces[2] = std::move(after);
        old.sort(), now.sort();
        return find_changed_part(old.faces[2], now.faces[2]);
    };
    EXPECT_TRUE(states({}, {}).is_empty());
    EXPECT_TRUE(states({{9, a}, {4, b}}, {{4, b}, {9, a}}).is_empty());
    EXPECT_EQ(states({{9, a}, {4, b}}, {{4, b}}), a) << "it has gone";
    EXPECT_EQ(states({{4, b}}, {{4, b}, {9, c}}), c) << "it has come";
    EXPECT_EQ(states({{4, b}}, {{5, c}}), unite(b, c)) << "both, where it was and where it is";
    EXPECT_EQ(states({{4, b}}, {{4, c}}), unite(b, c)) << "the shadow of what stays, elsewhere";
    EXPECT_EQ(states({{4, b}, {4, b}, {4, c}}, {{4, b}, {4, c}}), b) << "one of two alike";
}

} // namespace
