// What is refused of devices and images of a caller's; samples/embedded shows that the rest works.
#include "app/session.hpp"
#include "core/error.hpp"
#include "embed/embed.hpp"
#include "scene/load.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using testing::HasSubstr;

template <typename Call>
std::string refused(Call&& call) {
    try {
        call();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(Embed, ADeviceMustBeThere) {
    EXPECT_THAT(refused([] { embed::make_engine({}); }),
                HasSubstr("wants an instance, a physical device, a device and a queue"));
}

TEST(Embed, ATargetMustBeOneThatCanBeWritten) {
    app::Engine engine({});
    app::Session session(engine, scene::flat());
    app::FrameSpec spec{
        .techniques = {"reuse"}, .camera = session.scene().cameras.front(), .size = {16, 16}};
    const auto image = reinterpret_cast<VkImage>(std::uintptr_t{1}); // never touched
    EXPECT_THAT(refused([&] { embed::frame_into(session, spec, {}); }), HasSubstr("an image"));
    EXPECT_THAT(refused([&] {
                    embed::frame_into(session, spec, {image, VK_IMAGE_LAYOUT_UNDEFINED});
                }),
                HasSubstr("PRESENT_SRC_KHR, not in number 0"));
    spec.techniques.push_back("parallax");
    EXPECT_THAT(refused([&] { embed::frame_into(session, spec, {image}); }),
                HasSubstr("one technique, not 2"));
    EXPECT_EQ(session.counts().frames, 0u);
}

} // namespace
