// The module that links Draco; no other code uses it.
#include "core/draco_module.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <utility>

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

namespace catoptric {

namespace {

/// Returns the values of an attribute for each point of the mesh, converted to `Value`.
template <typename Value>
bool copy_values(const draco::Mesh& mesh, const draco::PointAttribute& from, DracoAttribute& to) {
    to.values.resize(mesh.num_points() * to.width * sizeof(Value));
    auto out = to.values.begin();
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
        std::array<Value, 4> value{};
        if (!from.ConvertValue<Value>(from.mapped_index(draco::PointIndex(i)),
                                      static_cast<std::int8_t>(to.width), value.data()))
            return false;
        out = std::copy_n(reinterpret_cast<const unsigned char*>(value.data()),
                          to.width * sizeof(Value), out);
    }
    return true;
}

bool copy_as_wanted(const draco::Mesh& mesh, const draco::PointAttribute& from,
                    DracoAttribute& to) {
    switch (to.type) {
    case DracoType::int8: return copy_values<std::int8_t>(mesh, from, to);
    case DracoType::uint8: return copy_values<std::uint8_t>(mesh, from, to);
    case DracoType::int16: return copy_values<std::int16_t>(mesh, from, to);
    case DracoType::uint16: return copy_values<std::uint16_t>(mesh, from, to);
    case DracoType::uint32: return copy_values<std::uint32_t>(mesh, from, to);
    case DracoType::float32: break;
    }
    return copy_values<float>(mesh, from, to);
}

void set_buffer(draco::DecoderBuffer& buffer, std::span<const unsigned char> bytes) {
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string read_counts(std::span<const unsigned char> bytes, DracoCounts& counts) {
    draco::DecoderBuffer buffer;
    set_buffer(buffer, bytes);
    draco::DracoHeader header{};
    const bool has_header = draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok();
    if (!has_header || header.version_major != 2 || header.version_minor != 2 ||
        header.encoder_type != draco::TRIANGULAR_MESH)
        return "wanted a triangle mesh in Draco's bitstream 2.2, found other bytes";
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
    bool is_read = true;
    if ((header.flags & METADATA_FLAG_MASK) != 0) {
        draco::GeometryMetadata metadata;
        is_read = draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata);
    }
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        std::uint8_t traversal = 0;
        is_read = is_read && buffer.Decode(&traversal) &&
                  draco::DecodeVarint(&counts.points, &buffer) &&
                  draco::DecodeVarint(&counts.triangles, &buffer);
    } else {
        is_read = is_read && draco::DecodeVarint(&counts.triangles, &buffer) &&
                  draco::DecodeVarint(&counts.points, &buffer);
    }
    return is_read ? "" : "wanted a triangle mesh in Draco's bitstream 2.2, found too few bytes";
}

std::string decode_mesh(std::span<const unsigned char> bytes,
                        std::vector<DracoAttribute>& attributes,
                        std::vector<std::uint32_t>& corners) {
    draco::DecoderBuffer buffer;
    set_buffer(buffer, bytes);
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return "cannot be decoded: " + decoded.status().error_msg_string();
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    if (mesh->num_points() == 0 || mesh->num_faces() == 0)
        return "wanted at least one triangle, found none";
    for (DracoAttribute& attribute : attributes) {
        const std::string what = "attribute " + std::to_string(attribute.id);
        const draco::PointAttribute* const from = mesh->GetAttributeByUniqueId(attribute.id);
        if (from == nullptr) return what + ": wanted one of Draco's data, found none with this id";
        const int width = static_cast<int>(attribute.width), found = from->num_components();
        if (found != width)
            return what + ": wanted " + std::to_string(width) + " components, found " +
                   std::to_string(found);
        if (!copy_as_wanted(*mesh, *from, attribute))
            return what + ": wanted values that fit the accessor's component type, found others";
    }
    for (std::uint32_t i = 0; i < mesh->num_faces(); ++i)
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(i)))
            corners.push_back(point.value());
    return "";
}

/// Returns the answer of `work`, or the text of an exception.
template <typename Work>
std::string catch_exceptions(const Work& work) noexcept {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        return "cannot be decoded: out of memory";
    } catch (const std::exception& error) {
        return std::string("cannot be decoded: ") + error.what();
    }
}

const DracoCodec kDracoCodec{
    .read_counts =
        [](std::span<const unsigned char> bytes, DracoCounts& counts) noexcept {
            return catch_exceptions([&] { return read_counts(bytes, counts); });
        },
    .decode =
        [](std::span<const unsigned char> bytes, std::vector<DracoAttribute>& attributes,
           std::vector<std::uint32_t>& corners) noexcept {
            return catch_exceptions([&] { return decode_mesh(bytes, attributes, corners); });
        }};

} // namespace

} // namespace catoptric

extern "C" [[gnu::visibility("default")]] const catoptric::DracoCodec* catoptric_draco_codec_1() {
    return &catoptric::kDracoCodec;
}
