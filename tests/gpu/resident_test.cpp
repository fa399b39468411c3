// Tests of a scene that stays on the device: which buffers are written, and which BVHs are built.
// Its pictures must equal those of a scene made for the frame.
#include "support/device.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"
#include "support/techniques.hpp"

#include <cstring>

namespace {

using namespace catoptric;

constexpr uvec2 kResidentSize{24, 24};

gpu::Device& device() { return test::test_device().device; }

/// Returns the linear picture of the resident scene as bytes.
std::vector<std::byte> resident_picture(const render::GpuScene& scene,
                                        const std::string& technique) {
    auto& [device, pipelines] = test::test_device();
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    const reflect::TechniqueOutputs outputs = test::add_technique(graph, {scene, kResidentSize, ""},
                                                                  technique);
    graph.mark_output(outputs.hdr);
    scene.prepare_frame();
    test::run_graph(runner, graph);
    return runner.read_resource(outputs.hdr);
}

/// A test room on the device whose objects, materials and camera tests change.
struct Live {
    explicit Live(std::size_t slots = 1)
        : now(test::make_lit_room(3, 2)), camera(now.cameras.front()),
          resident(device(), now, slots) {}
    /// Writes the changes to the device. Returns the number of buffer writes.
    std::size_t update(std::size_t slot = 0) {
        const std::size_t before = resident.uploads();
        resident.update(now, camera, kResidentSize, ambient, slot);
        return resident.uploads() - before;
    }
    dvec4& place(std::size_t object) { return now.objects[object].world_from_object[3]; }
    void move_ball(const dvec3& by) {
        scene::Object& ball = now.objects.back();
        ball.world_from_object[3] += dvec4(by, 0);
        ball.sphere->centre += by;
    }

    scene::Scene now;
    scene::Camera camera;
    double ambient = .05;
    render::GpuScene resident;
};

TEST(Resident, OnlyChangedBuffersAreWritten) {
    Live live;
    EXPECT_EQ(live.update(), 12u) << "all lists but the empty ones of what moves and of the sky";
    EXPECT_EQ(live.update(), 0u);
    live.camera.eye.x += .1;
    EXPECT_EQ(live.update(), 1u) << "views";
    live.ambient = .1;
    EXPECT_EQ(live.update(), 1u) << "frame";
    live.now.materials[1].albedo.x = .3f;
    EXPECT_EQ(live.update(), 1u) << "surfaces";
    live.now.materials[3].emission.x = 5;
    EXPECT_EQ(live.update(), 2u) << "surfaces, lights";
    live.move_ball({.1, 0, 0});
    live.update(); // the ball now belongs to the moving objects
    live.move_ball({.1, 0, 0});
    EXPECT_LE(live.update(), 7u) << "its vertices (up to 4 parts), surfaces, probes, views";
    EXPECT_EQ(live.update(), 0u);
}

TEST(Resident, HierarchiesAreBuiltOnlyForTracingTechniques) {
    Live live;
    live.update();
    resident_picture(live.resident, "parallax:face=16,shadow_map=16");
    EXPECT_EQ(live.resident.hierarchies_built(), 0u);
    EXPECT_EQ(live.resident.hierarchy_ms(), 0);
    for (int frame = 0; frame < 3; ++frame) {
        live.update();
        resident_picture(live.resident, "raytrace");
        EXPECT_EQ(live.resident.hierarchies_built(), 1u);
    }
    EXPECT_EQ(live.resident.hierarchies_refitted(), 0u);
    live.move_ball({.1, .1, 0});
    live.update();
    resident_picture(live.resident, "raytrace");
    EXPECT_EQ(live.resident.hierarchies_built(), 1u);
    EXPECT_EQ(live.resident.hierarchies_refitted(), 1u);
    // Move three balls out of the room, along three axes.
    for (std::size_t ball = 0; ball < 3; ++ball)
        live.place(live.now.objects.size() - 3 + ball)[static_cast<int>(ball)] += 30;
    live.update();
    resident_picture(live.resident, "raytrace");
    EXPECT_EQ(live.resident.hierarchies_built(), 2u) << "a refit twice as bad is none";
    EXPECT_GT(live.resident.update_ms(), 0);
    EXPECT_GT(live.resident.hierarchy_ms(), 0);
}

/// Shadow rays pass through walls that cast a shadow on nothing (render/backdrop.hpp). A light
/// outside the room makes the walls cast shadows, so it needs another hierarchy.
TEST(Resident, HierarchiesAreRebuiltWhenWallsBeginToCastShadows) {
    Live live;
    live.update();
    resident_picture(live.resident, "raytrace");
    live.now.punctual.push_back({.kind = scene::PunctualLight::Kind::point, .intensity = vec3(1)});
    live.update();
    resident_picture(live.resident, "raytrace");
    EXPECT_EQ(live.resident.hierarchies_built(), 1u) << "the light is in the room";
    live.now.punctual.back().world_from_light[3] = dvec4(0, 5, 0, 1);
    live.update();
    render::GpuScene fresh(device(), live.now);
    fresh.update(live.now, live.camera, kResidentSize, live.ambient);
    EXPECT_EQ(resident_picture(live.resident, "raytrace"), resident_picture(fresh, "raytrace"));
    EXPECT_EQ(live.resident.hierarchies_built(), 2u);
}

/// Makes one random change of the kinds that a program may make.
void change(Live& live, test::RandomNumbers& numbers) {
    const std::size_t object = numbers.integer_below(live.now.objects.size());
    const dvec3 by = .2 * dvec3(numbers.point_in_cube());
    switch (numbers.integer_below(8)) {
    case 0: live.camera.eye += by; break;
    case 1: live.move_ball(by); break;
    case 2: live.place(object) += dvec4(by, 0); break; // move any object, lamps too
    case 3:
        live.now.objects[object].material = numbers.integer_below(live.now.materials.size());
        break;
    case 4: live.now.materials[numbers.integer_below(3)].albedo.y = numbers.unit_fraction(); break;
    case 5: // add a light without a surface, or move the last one
        if (live.now.punctual.empty() || numbers.integer_below(2) == 0)
            live.now.punctual.push_back(
                {.kind = static_cast<scene::PunctualLight::Kind>(numbers.integer_below(3)),
                 .intensity = vec3(1)});
        live.now.punctual.back().world_from_light[3] += dvec4(by, 0);
        break;
    case 6: {
        scene::Environment studio{.studio = true};
        studio.scale = numbers.unit_fraction();
        live.now.environment = std::make_shared<const scene::Environment>(studio);
        break;
    }
    default: live.now.materials[3].emission *= .5f + numbers.unit_fraction(); break;
    }
}

TEST(Resident, ChangedSceneEqualsASceneMadeForTheFrame) {
    constexpr std::size_t kSlots = 3;
    Live live(kSlots);
    live.update();
    test::RandomNumbers numbers(5);
    const scene::Scene rest = live.now;
    for (std::size_t step = 0; step < 20; ++step) {
        change(live, numbers);
        live.update(step % kSlots);
        render::GpuScene fresh(device(), rest);
        fresh.update(live.now, live.camera, kResidentSize, live.ambient);
        for (const char* technique : {"raytrace", "parallax:face=16,shadow_map=16"})
            ASSERT_EQ(resident_picture(live.resident, technique),
                      resident_picture(fresh, technique))
                << technique << ", step " << step;
    }
    EXPECT_GT(live.resident.hierarchies_refitted(), 2u);
}

/// Turns two meshes in one update. Together they have more triangles than the update compares at a
/// time.
TEST(Resident, RaysSeeAllTurnedMeshes) {
    scene::Scene now = test::make_lit_room(0, 1);
    for (const double x : {-.4, .4}) {
        scene::add_ball(now, "fine", 0, dvec3(x, 0, 0), .3);
        now.meshes.back() = scene::ball("fine", 4);
    }
    render::GpuScene live(device(), now, 1), fresh(device(), now, 1);
    const scene::Camera camera = now.cameras.front();
    live.update(now, camera, kResidentSize, .05);
    const std::vector<std::byte> before = resident_picture(live, "raytrace");
    for (std::size_t object = now.objects.size() - 2; object < now.objects.size(); ++object) {
        dmat4& place = now.objects[object].world_from_object;
        place = dmat4(place[1], -place[0], place[2], place[3]);
    }
    live.update(now, camera, kResidentSize, .05);
    fresh.update(now, camera, kResidentSize, .05);
    EXPECT_NE(resident_picture(live, "raytrace"), before);
    EXPECT_EQ(resident_picture(live, "raytrace"), resident_picture(fresh, "raytrace"));
}

/// Tests a scene of 50 million triangles. Its copies cannot share the trees of their mesh, so the
/// scene is refused for its number of triangles before any vertex is made.
TEST(Resident, SceneTooLargeForTheDeviceIsRefused) {
    scene::Scene scene = test::make_lit_room(0, 1);
    scene::add_ball(scene, "ball", 0, dvec3(0), .5);
    scene.meshes.back() = scene::ball("ball", 7); // a mesh of 65,536 triangles
    scene.objects.resize(800, scene.objects.back());
    EXPECT_NO_THROW(render::GpuScene(device(), scene)) << "one mesh";
    for (scene::Object& object : scene.objects)
        object.world_from_object[1].x = 1e3; // a shear too large to transform rays in floats
    try {
        render::GpuScene refused(device(), scene);
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::exhausted);
        EXPECT_NE(std::string(error.what()).find("scene 'room' wants "), std::string::npos)
            << error.what();
        EXPECT_NE(std::string(error.what()).find(", the device allows "), std::string::npos);
    }
}

std::vector<std::uint32_t> words(const gpu::Buffer& buffer, std::size_t count) {
    const std::vector<std::byte> bytes = buffer.read();
    std::vector<std::uint32_t> result(count);
    std::memcpy(result.data(), bytes.data(), count * sizeof(std::uint32_t));
    return result;
}

/// The buffer that a slot binds must keep its content until that slot writes again.
TEST(Resident, FramesInFlightKeepTheirRecordedBuffers) {
    constexpr std::size_t kSlots = 3, kWords = 9000;
    render::DeviceList list("list", gpu::BufferUsage::plain, kSlots);
    std::vector<std::uint32_t> now(kWords, 1);
    list.set_contents(now);
    for (std::size_t slot = 0; slot < kSlots; ++slot) list.write_changed_pages(device(), slot);
    EXPECT_EQ(list.copy_count(), 1u) << "nothing has changed: one copy";
    std::vector<std::vector<std::uint32_t>> bound(kSlots, now);
    test::RandomNumbers numbers(6);
    for (std::size_t frame = 0; frame < 40; ++frame) {
        if (numbers.integer_below(3) > 0)
            now[numbers.integer_below(kWords)] = numbers.random_word();
        list.set_contents(now);
        const std::size_t slot = frame % kSlots;
        list.write_changed_pages(device(), slot);
        bound[slot] = now;
        for (std::size_t other = 0; other < kSlots; ++other)
            ASSERT_EQ(words(list.buffer_of_copy(other), kWords), bound[other]) << "frame " << frame;
    }
    EXPECT_LE(list.copy_count(), kSlots);
}

TEST(Resident, OnlyChangedPartsOfABufferAreWritten) {
    render::DeviceList list("list", gpu::BufferUsage::plain, 1);
    std::vector<std::uint32_t> now(100000, 1);
    list.set_contents(now);
    EXPECT_EQ(list.write_changed_pages(device(), 0), 1u);
    now[10] = now[20] = now[60000] = 2;
    list.set_contents(now);
    EXPECT_EQ(list.write_changed_pages(device(), 0), 2u);
    EXPECT_EQ(words(list.buffer_of_copy(0), now.size()), now);
    now.resize(200000, 3);
    list.set_contents(now);
    list.write_changed_pages(device(), 0);
    EXPECT_EQ(words(list.buffer_of_copy(0), now.size()), now);
}

} // namespace
