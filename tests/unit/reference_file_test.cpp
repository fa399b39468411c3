// Tests of files that store the two halves of a noisy reference.
#include "study/reference_file.hpp"

#include "measure/layered_file.hpp"
#include "support/folder.hpp"
#include "support/numbers.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using testing::AllOf;
using testing::HasSubstr;

measure::Picture draw_random_picture(std::uint64_t seed) {
    test::RandomNumbers numbers(seed);
    measure::Picture picture(5, 3);
    for (vec3& pixel : picture.pixels) pixel = numbers.random_point_in_cube() * 3.f;
    return picture;
}

study::StoredReference make_stored_reference() {
    study::StoredReference stored{.seeds = {1, 2, 4, 5}, .gpu_ms = {1.5, 2.5}, .rays = 8};
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        stored.a.add(draw_random_picture(seed));
        stored.b.add(draw_random_picture(seed + 10));
    }
    return stored;
}

const study::ReferenceKey kTestReferenceKey{
    {"scene", "cafe"}, {"camera", "0,0,1"}, {"time", "0"}, {"size", "5x3"}};

using ReferenceFileTest = test::InFolder;

TEST_F(ReferenceFileTest, KeepsHalvesVarianceSeedsAndTimes) {
    const study::StoredReference before = make_stored_reference();
    study::write_reference_file(before, kTestReferenceKey, folder / "halves.exr");
    study::StoredReference after = study::read_reference_file(kTestReferenceKey,
                                                              folder / "halves.exr");
    EXPECT_EQ(after.seeds, before.seeds);
    EXPECT_EQ(after.gpu_ms, before.gpu_ms);
    EXPECT_EQ(after.rays, 8);
    EXPECT_EQ(after.a.count(), 2);
    EXPECT_EQ(after.a.mean().pixels, before.a.mean().pixels);
    EXPECT_EQ(after.b.mean().pixels, before.b.mean().pixels);
    // Frames that are added later continue the stored mean and variance.
    study::StoredReference longer = before;
    for (measure::PictureMean* mean : {&after.b, &longer.b}) mean->add(draw_random_picture(30));
    for (std::size_t i = 0; i < 15; ++i)
        for (int channel = 0; channel < 3; ++channel) {
            EXPECT_NEAR(after.b.mean().pixels[i][channel], longer.b.mean().pixels[i][channel],
                        1e-6);
            EXPECT_NEAR(after.b.variance().pixels[i][channel],
                        longer.b.variance().pixels[i][channel], 1e-5);
        }
}

TEST_F(ReferenceFileTest, NamesThePartOfTheKeyThatDiffers) {
    const std::filesystem::path file = folder / "halves.exr";
    study::write_reference_file(make_stored_reference(), kTestReferenceKey, file);
    for (const auto& [name, value] : kTestReferenceKey) {
        study::ReferenceKey other = kTestReferenceKey;
        for (auto& part : other)
            if (part.first == name) part.second = "another";
        EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                           [&] { study::read_reference_file(other, file); }),
                    AllOf(HasSubstr("the " + name + " another"), HasSubstr(value)));
    }
    measure::write_exr(draw_random_picture(1), file);
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data,
                               [&] { study::read_reference_file(kTestReferenceKey, file); }),
        HasSubstr("wanted the channel A.R"));
    EXPECT_THAT(test::catch_error_text(
                    Failure::missing_input,
                    [&] { study::read_reference_file(kTestReferenceKey, folder / "none.exr"); }),
                HasSubstr("none.exr"));
}

} // namespace
