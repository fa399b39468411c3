// Program `encode_draco METHOD BITS`: writes the test mesh `BentGrid` to stdout, compressed by
// Draco. METHOD is edgebreaker, sequential, or described: sequential, with metadata. The code is a
// separate program, because Debian's libdraco exports symbols of another version of tinygltf.
#include "support/bent_grid.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

int main(int count, char** words) {
    if (count != 3) return 2;
    const test::BentGrid grid;
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(grid.corners.size() / 3));
    const auto add = [&](draco::GeometryAttribute::Type type, const std::vector<float>& values,
                         std::size_t width) {
        const int id = builder.AddAttribute(type, static_cast<std::int8_t>(width),
                                            draco::DT_FLOAT32);
        for (std::size_t face = 0; face * 3 < grid.corners.size(); ++face)
            builder.SetAttributeValuesForFace(id,
                                              draco::FaceIndex(static_cast<std::uint32_t>(face)),
                                              &values[grid.corners[face * 3] * width],
                                              &values[grid.corners[face * 3 + 1] * width],
                                              &values[grid.corners[face * 3 + 2] * width]);
    };
    add(draco::GeometryAttribute::POSITION, grid.positions, 3);
    add(draco::GeometryAttribute::NORMAL, grid.normals, 3);
    add(draco::GeometryAttribute::TEX_COORD, grid.uv, 2);
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(std::string(words[1]) == "edgebreaker"
                                  ? draco::MESH_EDGEBREAKER_ENCODING
                                  : draco::MESH_SEQUENTIAL_ENCODING);
    if (std::string(words[1]) == "described") {
        auto metadata = std::make_unique<draco::GeometryMetadata>();
        metadata->AddEntryString("name", "grid");
        mesh->AddMetadata(std::move(metadata));
    }
    const int bits = std::atoi(words[2]);
    for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                            draco::GeometryAttribute::TEX_COORD})
        if (bits > 0) encoder.SetAttributeQuantization(type, bits);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return 1;
    std::cout.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    return std::cout ? 0 : 1;
}
