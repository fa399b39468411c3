// Tests of the files that a scene may refer to. The file that is opened must be the file that
// passed the checks.
#include "import/file_options.hpp"
#include "unit/load_fixture.hpp"

#include <sys/stat.h>

namespace {

using namespace test::loading;

class LoadFilesTest : public Load {
protected:
    /// Returns the position bytes of a triangle that is `size` wide.
    static std::string encode_triangle_positions(float size) {
        const float numbers[] = {0, 0, 0, size, 0, 0, 0, size, 0};
        return {reinterpret_cast<const char*>(numbers), sizeof numbers};
    }
    static std::string make_gltf_with_buffer_uri(const std::string& uri) {
        const std::string data = make_gltf_text().substr(make_gltf_text().find("data:"));
        return make_gltf_text(data.substr(0, data.find('"')), uri);
    }
    double load_triangle_width(const std::string& uri, const FileOptions& options = {}) const {
        return bounds(load_file(write_loaded_file("in/x.gltf", make_gltf_with_buffer_uri(uri)),
                                options))
            .hi.x;
    }
    std::string uri_error_text(const std::string& uri, Failure failure = Failure::bad_data) const {
        return load_error_text("in/x.gltf", make_gltf_with_buffer_uri(uri), failure);
    }
    void SetUp() override {
        fs::create_directories(folder / "in");
        fs::create_directories(folder / "out");
        write_loaded_file("out/secret.bin", encode_triangle_positions(7));
    }
};

TEST_F(LoadFilesTest, UriIsPercentDecodedOnlyOnce) {
    write_loaded_file("in/a+b.bin", encode_triangle_positions(1)),
        write_loaded_file("in/a b.bin", encode_triangle_positions(2));
    write_loaded_file("in/%41.bin", encode_triangle_positions(3)),
        write_loaded_file("in/A.bin", encode_triangle_positions(4));
    write_loaded_file("in/100%.bin", encode_triangle_positions(5)),
        write_loaded_file("in/ü.bin", encode_triangle_positions(6));
    EXPECT_EQ(load_triangle_width("a+b.bin"), 1);
    EXPECT_EQ(load_triangle_width("a%2Bb.bin"), 1);
    EXPECT_EQ(load_triangle_width("a%20b.bin"), 2);
    EXPECT_EQ(load_triangle_width("a b.bin"), 2);
    EXPECT_EQ(load_triangle_width("%2541.bin"), 3);
    EXPECT_EQ(load_triangle_width("%41.bin"), 4);
    EXPECT_EQ(load_triangle_width("100%.bin"), 5);
    EXPECT_EQ(load_triangle_width("%c3%bc.bin"), 6);
    EXPECT_EQ(load_triangle_width("../in/./a+b.bin"), 1);
}

TEST_F(LoadFilesTest, UriMustBeARelativePath) {
    EXPECT_THAT(uri_error_text("/etc/passwd"),
                AllOf(HasSubstr("buffers[0]: uri"), HasSubstr("absolute")));
    EXPECT_THAT(uri_error_text("%2fetc/passwd"), HasSubstr("absolute"));
    EXPECT_THAT(uri_error_text("file:secret.bin"), HasSubstr("scheme"));
    EXPECT_THAT(uri_error_text("http://x/y.bin"), HasSubstr("scheme"));
    EXPECT_THAT(uri_error_text("..%5cout%5csecret.bin"), HasSubstr("backslash"));
    EXPECT_THAT(uri_error_text("a.bin%00.png"), HasSubstr("NUL"));
    EXPECT_THAT(uri_error_text(""), HasSubstr("relative to the scene, found ''"));
    EXPECT_THAT(uri_error_text("."), HasSubstr("'.', which is a folder"));
    EXPECT_THAT(uri_error_text(std::string(1025, 'a')), HasSubstr("(1025 bytes)"));
    EXPECT_THAT(uri_error_text("gone.bin", Failure::missing_input),
                HasSubstr("'gone.bin' is not there"));
}

TEST_F(LoadFilesTest, FilesAboveTheSceneFolderAreRefused) {
    for (const char* uri : {"../out/secret.bin", "%2e%2e/out/secret.bin", "../gone.bin",
                            "sub/../../out/secret.bin", "../../../../../../../../etc/passwd"})
        EXPECT_THAT(uri_error_text(uri),
                    AllOf(HasSubstr("wanted a file below '"), HasSubstr("/in'"),
                          HasSubstr("--root"), HasSubstr("found '")))
            << uri;
    EXPECT_EQ(load_triangle_width("../out/secret.bin", {.root = folder}), 7);
    EXPECT_EQ(load_triangle_width("../out/secret.bin", {.root = folder / "out"}), 7);
    EXPECT_THAT(load_error_text("in/x.gltf", make_gltf_with_buffer_uri("../out/secret.bin"),
                                Failure::bad_data, {.root = folder / "in"}),
                HasSubstr("--root"));
    // The path of this file begins with the name of the folder "in", but the file is not in that
    // folder.
    write_loaded_file("inside.bin", encode_triangle_positions(1));
    EXPECT_THAT(uri_error_text("../inside.bin"), HasSubstr("--root"));
}

TEST_F(LoadFilesTest, LinksAreResolvedBeforeTheFolderIsChecked) {
    write_loaded_file("in/own.bin", encode_triangle_positions(1));
    fs::create_symlink("own.bin", folder / "in/link.bin");
    fs::create_symlink("../out/secret.bin", folder / "in/secret.bin");
    fs::create_directory_symlink("../out", folder / "in/sub");
    fs::create_symlink("loop.bin", folder / "in/loop.bin");
    EXPECT_EQ(load_triangle_width("link.bin"), 1);
    for (const char* uri : {"secret.bin", "sub/secret.bin"}) {
        const std::string real = fs::canonical(folder / "out/secret.bin").string();
        EXPECT_THAT(uri_error_text(uri),
                    AllOf(HasSubstr(uri), HasSubstr(real), HasSubstr("--root")));
        EXPECT_EQ(load_triangle_width(uri, {.root = folder / "out"}), 7);
    }
    EXPECT_THAT(uri_error_text("sub/gone.bin"), HasSubstr("--root"))
        << "nothing is told of what is there";
    EXPECT_THAT(uri_error_text("loop.bin", Failure::missing_input),
                HasSubstr("'loop.bin' cannot be reached: "));
    // The user named the scene itself, so the path to the scene may contain links.
    fs::create_directory_symlink("in", folder / "door");
    load_triangle_width("link.bin");
    EXPECT_EQ(triangle_count(load((folder / "door/x.gltf").string())), 1u);
}

TEST_F(LoadFilesTest, OnlyRegularFilesAreRead) {
    fs::create_directories(folder / "in/sub");
    ASSERT_EQ(::mkfifo((folder / "in/pipe.bin").c_str(), 0600), 0);
    EXPECT_THAT(uri_error_text("sub"), HasSubstr("a folder"));
    EXPECT_THAT(uri_error_text("pipe.bin"), HasSubstr("a device or a pipe"));
    ASSERT_EQ(::mkfifo((folder / "in/pipe.obj").c_str(), 0600), 0);
    EXPECT_THAT([&] { load((folder / "in/pipe.obj").string()); },
                testing::ThrowsMessage<Error>(HasSubstr("a device or a pipe")));
}

TEST_F(LoadFilesTest, MaterialLibrariesAndMapsAboveTheFolderAreRefused) {
    write_loaded_file("out/m.mtl", "newmtl a\n");
    write_loaded_file("in/m.mtl", "newmtl a\nmap_Kd -s 1 1 1 -clamp on wood and stone.png\n");
    fs::create_symlink("../out/m.mtl", folder / "in/link.mtl");
    const std::string rest = kTriangle + "usemtl a\nf 1 2 3\n";
    EXPECT_EQ(load(write_loaded_file("in/x.obj", "mtllib m.mtl\n" + rest)).files.size(), 2u);
    for (const char* name : {"../out/m.mtl", "link.mtl", "/etc/passwd"})
        EXPECT_THAT(load_error_text("in/x.obj", std::string("mtllib ") + name + "\n" + rest),
                    AllOf(HasSubstr("x.obj:1: mtllib"), HasSubstr(name), HasSubstr("--root")));
    write_loaded_file("in/m.mtl", "newmtl a\nmap_Kd -bm 2 ../out/x y.png\n");
    write_loaded_file("in/x.obj", "mtllib m.mtl\n" + rest);
    EXPECT_THAT([&] { load((folder / "in/x.obj").string()); },
                testing::ThrowsMessage<Error>(AllOf(
                    HasSubstr("m.mtl:2"), HasSubstr("'../out/x y.png'"), HasSubstr("--root"))));
    EXPECT_EQ(load((folder / "in/x.obj").string(), {.root = folder}).objects.size(), 1u);
}

TEST_F(LoadFilesTest, ImagesAboveTheFolderAreRefused) {
    const auto with_image = [](const std::string& uri) {
        return make_gltf_text("\"scene\":0", "\"scene\":0,\"images\":[{\"uri\":\"" + uri + "\"}]");
    };
    EXPECT_THAT(load_error_text("in/x.gltf", with_image("../out/secret.bin")),
                AllOf(HasSubstr("images[0]"), HasSubstr("--root")));
    EXPECT_THAT(load_error_text("in/x.gltf", with_image("/etc/passwd")), HasSubstr("absolute"));
    const Scene scene = load(write_loaded_file("in/x.gltf", with_image("gone.png")));
    EXPECT_EQ(scene.files.size(), 1u) << "what is not there is no file of it";
}

TEST_F(LoadFilesTest, SceneListsItsFiles) {
    write_loaded_file("in/a.bin", encode_triangle_positions(1)),
        write_loaded_file("in/wood.png", "not looked into");
    fs::create_symlink("a.bin", folder / "in/b.bin");
    const Scene scene = load(write_loaded_file("in/x.gltf", [&] {
        std::string text = make_gltf_with_buffer_uri("b.bin");
        return text.replace(
            text.find("\"scene\":0"), 9,
            "\"scene\":0,\"images\":[{\"uri\":\"wood.png\"},{\"uri\":\"gone.png\"}]");
    }()));
    const fs::path in = fs::canonical(folder / "in");
    EXPECT_THAT(scene.files, testing::ElementsAre(in / "x.gltf", in / "a.bin", in / "wood.png"));
    EXPECT_THAT(load("cornell-mirrors").files, testing::IsEmpty());
}

TEST_F(LoadFilesTest, FileOfManyBuffersCountsOnce) {
    write_loaded_file("in/a.bin", encode_triangle_positions(1));
    std::string text = make_gltf_with_buffer_uri("a.bin");
    std::string more;
    for (int i = 0; i < 100; ++i) more += ",{\"byteLength\":36,\"uri\":\"./a.bin\"}";
    text.insert(text.rfind(']'), more);
    LoadBudget budget;
    budget.file_bytes = text.size() + 36;
    EXPECT_EQ(load_file(write_loaded_file("in/x.gltf", text), {.budget = budget}).files.size(), 2u);
}

TEST_F(LoadFilesTest, RootMustBeAFolder) {
    const std::string path = write_loaded_file("in/x.gltf", make_gltf_text());
    for (const fs::path& root : {folder / "gone", fs::path(path)})
        EXPECT_THAT([&] { load(path, {.root = root}); },
                    testing::ThrowsMessage<Error>(
                        AllOf(HasSubstr("--root: wanted a folder"), HasSubstr(root.string()))));
}

TEST_F(LoadFilesTest, DataUrisMustBeValidBase64) {
    EXPECT_THAT(uri_error_text("data:text/plain,abc"), HasSubstr("base64"));
    EXPECT_THAT(uri_error_text("data:;base64"), HasSubstr("base64"));
    EXPECT_THAT(uri_error_text("data:;base64,AA*A"), HasSubstr("'*'"));
    EXPECT_THAT(uri_error_text("data:;base64,AA=A"), HasSubstr("'='"));
    EXPECT_THAT(uri_error_text("data:;base64,AAAAA"), HasSubstr("one more"));
    EXPECT_THAT(uri_error_text("data:;base64,AAAA"), HasSubstr("wanted 1 to 3"));
    EXPECT_EQ(load_triangle_width("data:application/gltf-buffer;base64,"
                                  "AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAgD8AAAAA"),
              2);
}

} // namespace
