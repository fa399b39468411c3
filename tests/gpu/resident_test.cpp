// Tests of a scene that stays on the device: which buffers are written, and which BVHs are built.
// Its pictures must equal those of a scene made for the frame.
#include "support/device.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"
#include "support/techniques.hpp"

#include <cstring>

namespace {

using namespace catoptric;

constexpr uvec2 kResidentPictureSize{24, 24};

gpu::Device& resident_test_device() { return test::get_test_device().device; }

/// Returns the linear picture of the resident scene as bytes.
std::vector<std::byte> render_resident_scene(render::GpuScene& scene,
                                             const std::string& technique) {
    auto& [device, pipelines] = test::get_test_device();
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    render::FrameRequests requests(scene.next_view());
    const reflect::TechniqueOutputs outputs = test::add_technique(
        graph, {scene, requests, kResidentPictureSize, ""}, technique);
    graph.output(outputs.hdr);
    scene.fulfil(requests, [] {});
    test::run_graph(runner, graph);
    return runner.read_back(outputs.hdr);
}

/// A test room on the device whose objects, materials and camera tests change.
struct EditableResidentScene {
    explicit EditableResidentScene(std::size_t slots = 1)
        : current_scene(test::make_lit_room(3, 2)), camera(current_scene.cameras.front()),
          resident(resident_test_device(), current_scene, slots) {}
    /// Writes the changes to the device. Returns the number of buffer writes.
    std::size_t write_changes_to_device(std::size_t slot = 0) {
        const std::size_t before = resident.write_count();
        resident.update(current_scene, camera, kResidentPictureSize, ambient, slot);
        return resident.write_count() - before;
    }
    dvec4& object_translation(std::size_t object) {
        return current_scene.objects[object].world_from_object[3];
    }
    void move_mirror_ball(const dvec3& by) {
        scene::Object& ball = current_scene.objects.back();
        ball.world_from_object[3] += dvec4(by, 0);
        ball.sphere->centre += by;
    }

    scene::Scene current_scene;
    scene::Camera camera;
    double ambient = .05;
    render::GpuScene resident;
};

TEST(Resident, OnlyChangedBuffersAreWritten) {
    EditableResidentScene live;
    EXPECT_EQ(live.write_changes_to_device(), 12u)
        << "all lists but the empty ones of what moves and of the sky";
    EXPECT_EQ(live.write_changes_to_device(), 0u);
    live.camera.eye.x += .1;
    EXPECT_EQ(live.write_changes_to_device(), 1u) << "views";
    live.ambient = .1;
    EXPECT_EQ(live.write_changes_to_device(), 1u) << "frame";
    live.current_scene.materials[1].albedo.x = .3f;
    EXPECT_EQ(live.write_changes_to_device(), 1u) << "surfaces";
    live.current_scene.materials[3].emission.x = 5;
    EXPECT_EQ(live.write_changes_to_device(), 2u) << "surfaces, lights";
    live.move_mirror_ball({.1, 0, 0});
    live.write_changes_to_device(); // the ball now belongs to the moving objects
    live.move_mirror_ball({.1, 0, 0});
    EXPECT_LE(live.write_changes_to_device(), 7u)
        << "its vertices (up to 4 parts), surfaces, probes, views";
    EXPECT_EQ(live.write_changes_to_device(), 0u);
}

TEST(Resident, HierarchiesAreBuiltOnlyForTracingTechniques) {
    EditableResidentScene live;
    live.write_changes_to_device();
    render_resident_scene(live.resident, "parallax:face=16,shadow_map=16");
    EXPECT_EQ(live.resident.built_bvhs(), 0u);
    EXPECT_EQ(live.resident.bvh_update_ms(), 0);
    for (int frame = 0; frame < 3; ++frame) {
        live.write_changes_to_device();
        render_resident_scene(live.resident, "raytrace");
        EXPECT_EQ(live.resident.built_bvhs(), 1u);
    }
    EXPECT_EQ(live.resident.refitted_bvhs(), 0u);
    live.move_mirror_ball({.1, .1, 0});
    live.write_changes_to_device();
    render_resident_scene(live.resident, "raytrace");
    EXPECT_EQ(live.resident.built_bvhs(), 1u);
    EXPECT_EQ(live.resident.refitted_bvhs(), 1u);
    // Move three balls out of the room, along three axes.
    for (std::size_t ball = 0; ball < 3; ++ball)
        live.object_translation(live.current_scene.objects.size() - 3 +
                                ball)[static_cast<int>(ball)] += 30;
    live.write_changes_to_device();
    render_resident_scene(live.resident, "raytrace");
    EXPECT_EQ(live.resident.built_bvhs(), 2u) << "a refit twice as bad is none";
    EXPECT_GT(live.resident.update_ms(), 0);
    EXPECT_GT(live.resident.bvh_update_ms(), 0);
}

/// Shadow rays pass through walls that cast a shadow on nothing (render/backdrop.hpp). A light
/// outside the room makes the walls cast shadows, so it needs another hierarchy.
TEST(Resident, HierarchiesAreRebuiltWhenWallsBeginToCastShadows) {
    EditableResidentScene live;
    live.write_changes_to_device();
    render_resident_scene(live.resident, "raytrace");
    live.current_scene.punctual.push_back(
        {.kind = scene::PunctualLight::Kind::point, .intensity = vec3(1)});
    live.write_changes_to_device();
    render_resident_scene(live.resident, "raytrace");
    EXPECT_EQ(live.resident.built_bvhs(), 1u) << "the light is in the room";
    live.current_scene.punctual.back().world_from_light[3] = dvec4(0, 5, 0, 1);
    live.write_changes_to_device();
    render::GpuScene fresh(resident_test_device(), live.current_scene);
    fresh.update(live.current_scene, live.camera, kResidentPictureSize, live.ambient);
    EXPECT_EQ(render_resident_scene(live.resident, "raytrace"),
              render_resident_scene(fresh, "raytrace"));
    EXPECT_EQ(live.resident.built_bvhs(), 2u);
}

/// Makes one random change of the kinds that a program may make.
void make_random_resident_change(EditableResidentScene& live, test::RandomNumbers& numbers) {
    const std::size_t object = numbers.random_integer_below(live.current_scene.objects.size());
    const dvec3 by = .2 * dvec3(numbers.random_point_in_cube());
    switch (numbers.random_integer_below(8)) {
    case 0: live.camera.eye += by; break;
    case 1: live.move_mirror_ball(by); break;
    case 2: live.object_translation(object) += dvec4(by, 0); break; // move any object, lamps too
    case 3:
        live.current_scene.objects[object].material = numbers.random_integer_below(
            live.current_scene.materials.size());
        break;
    case 4:
        live.current_scene.materials[numbers.random_integer_below(3)].albedo.y =
            numbers.random_unit_fraction();
        break;
    case 5: // add a light without a surface, or move the last one
        if (live.current_scene.punctual.empty() || numbers.random_integer_below(2) == 0)
            live.current_scene.punctual.push_back(
                {.kind = static_cast<scene::PunctualLight::Kind>(numbers.random_integer_below(3)),
                 .intensity = vec3(1)});
        live.current_scene.punctual.back().world_from_light[3] += dvec4(by, 0);
        break;
    case 6: {
        scene::Environment studio{.studio = true};
        studio.scale = numbers.random_unit_fraction();
        live.current_scene.environment = std::make_shared<const scene::Environment>(studio);
        break;
    }
    default:
        live.current_scene.materials[3].emission *= .5f + numbers.random_unit_fraction();
        break;
    }
}

TEST(Resident, ChangedSceneEqualsASceneMadeForTheFrame) {
    constexpr std::size_t kListSlotCount = 3;
    EditableResidentScene live(kListSlotCount);
    live.write_changes_to_device();
    test::RandomNumbers numbers(5);
    const scene::Scene rest = live.current_scene;
    for (std::size_t step = 0; step < 20; ++step) {
        make_random_resident_change(live, numbers);
        live.write_changes_to_device(step % kListSlotCount);
        render::GpuScene fresh(resident_test_device(), rest);
        fresh.update(live.current_scene, live.camera, kResidentPictureSize, live.ambient);
        for (const char* technique : {"raytrace", "parallax:face=16,shadow_map=16"})
            ASSERT_EQ(render_resident_scene(live.resident, technique),
                      render_resident_scene(fresh, technique))
                << technique << ", step " << step;
    }
    EXPECT_GT(live.resident.refitted_bvhs(), 2u);
}

/// Turns two meshes in one update. Together they have more triangles than the update compares at a
/// time.
TEST(Resident, RaysSeeAllTurnedMeshes) {
    scene::Scene now = test::make_lit_room(0, 1);
    for (const double x : {-.4, .4}) {
        scene::add_ball(now, "fine", 0, dvec3(x, 0, 0), .3);
        now.meshes.back() = scene::ball("fine", 4);
    }
    render::GpuScene live(resident_test_device(), now, 1), fresh(resident_test_device(), now, 1);
    const scene::Camera camera = now.cameras.front();
    live.update(now, camera, kResidentPictureSize, .05);
    const std::vector<std::byte> before = render_resident_scene(live, "raytrace");
    for (std::size_t object = now.objects.size() - 2; object < now.objects.size(); ++object) {
        dmat4& place = now.objects[object].world_from_object;
        place = dmat4(place[1], -place[0], place[2], place[3]);
    }
    live.update(now, camera, kResidentPictureSize, .05);
    fresh.update(now, camera, kResidentPictureSize, .05);
    EXPECT_NE(render_resident_scene(live, "raytrace"), before);
    EXPECT_EQ(render_resident_scene(live, "raytrace"), render_resident_scene(fresh, "raytrace"));
}

/// Tests a scene of 50 million triangles. Its copies cannot share the trees of their mesh, so the
/// scene is refused for its number of triangles before any vertex is made.
TEST(Resident, SceneTooLargeForTheDeviceIsRefused) {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene::add_ball(scene, "ball", 0, dvec3(0), .5);
    scene.meshes.back() = scene::ball("ball", 7); // a mesh of 65,536 triangles
    scene.objects.resize(800, scene.objects.back());
    EXPECT_NO_THROW(render::GpuScene(resident_test_device(), scene)) << "one mesh";
    for (scene::Object& object : scene.objects)
        object.world_from_object[1].x = 1e3; // a shear too large to transform rays in floats
    try {
        render::GpuScene refused(resident_test_device(), scene);
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::exhausted);
        EXPECT_NE(std::string(error.what()).find("scene 'room' wants "), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find(", the device allows "), std::string::npos);
    }
}

std::vector<std::uint32_t> read_buffer_words(const gpu::Buffer& buffer, std::size_t count) {
    const std::vector<std::byte> bytes = buffer.read();
    std::vector<std::uint32_t> result(count);
    std::memcpy(result.data(), bytes.data(), count * sizeof(std::uint32_t));
    return result;
}

/// A buffer that a frame in flight binds must keep its contents until the next frame in the same
/// slot is written.
TEST(Resident, FramesInFlightKeepTheirRecordedBuffers) {
    constexpr std::size_t kListSlotCount = 3, kListWordCount = 9000;
    render::DeviceList list("list", gpu::BufferUsage::plain, kListSlotCount);
    std::vector<std::uint32_t> current_words(kListWordCount, 1);
    list.set(current_words);
    for (std::size_t slot = 0; slot < kListSlotCount; ++slot)
        list.write(resident_test_device(), slot);
    EXPECT_EQ(list.copy_count(), 1u) << "nothing has changed: one copy";
    std::vector<std::vector<std::uint32_t>> bound(kListSlotCount, current_words);
    test::RandomNumbers numbers(6);
    for (std::size_t frame = 0; frame < 40; ++frame) {
        if (numbers.random_integer_below(3) > 0)
            current_words[numbers.random_integer_below(kListWordCount)] = numbers.random_word();
        list.set(current_words);
        const std::size_t slot = frame % kListSlotCount;
        list.write(resident_test_device(), slot);
        bound[slot] = current_words;
        for (std::size_t other = 0; other < kListSlotCount; ++other)
            ASSERT_EQ(read_buffer_words(list.buffer(other), kListWordCount), bound[other])
                << "frame " << frame;
    }
    EXPECT_LE(list.copy_count(), kListSlotCount);
}

TEST(Resident, OnlyChangedPartsOfABufferAreWritten) {
    render::DeviceList list("list", gpu::BufferUsage::plain, 1);
    std::vector<std::uint32_t> current_words(100000, 1);
    list.set(current_words);
    EXPECT_EQ(list.write(resident_test_device(), 0), 1u);
    current_words[10] = current_words[20] = current_words[60000] = 2;
    list.set(current_words);
    EXPECT_EQ(list.write(resident_test_device(), 0), 2u);
    EXPECT_EQ(read_buffer_words(list.buffer(0), current_words.size()), current_words);
    current_words.resize(200000, 3);
    list.set(current_words);
    list.write(resident_test_device(), 0);
    EXPECT_EQ(read_buffer_words(list.buffer(0), current_words.size()), current_words);
}

} // namespace
