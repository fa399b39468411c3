// Pictures as arrays: files, and differences of two pictures.
#include "binding.hpp"

#include <catoptric/error.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace catoptric::python {

static_assert(sizeof(vec3) == 3 * sizeof(float), "arrays share the memory of pictures");

namespace {

using MaskArgument = nb::ndarray<const bool, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Metrics of two pictures, and the FLIP map.
struct PictureDifference {
    measure::Difference metrics;
    std::vector<float> flip_map;
    std::size_t width = 0, height = 0;
};

measure::Picture apply_exposure(measure::Picture picture, double stops) {
    if (stops == 0) return picture;
    const double factor = std::exp2(stops);
    for (vec3& pixel : picture.pixels) pixel = vec3(dvec3(pixel) * factor);
    return picture;
}

PictureDifference compare_pictures(const PictureArgument& a_array, const PictureArgument& b_array,
                                   double exposure, const std::optional<MaskArgument>& mask_array,
                                   double pixels_per_degree) {
    measure::Picture a = copy_picture(a_array), b = copy_picture(b_array);
    measure::Mask mask;
    if (mask_array) {
        if (mask_array->shape(0) != a_array.shape(0) || mask_array->shape(1) != a_array.shape(1))
            throw BadData("mask: wanted the shape (height, width) of the pictures, (" +
                          std::to_string(a.height) + ", " + std::to_string(a.width) + "), found (" +
                          std::to_string(mask_array->shape(0)) + ", " +
                          std::to_string(mask_array->shape(1)) + ")");
        mask.assign(mask_array->data(), mask_array->data() + mask_array->size());
    }
    const nb::gil_scoped_release released;
    PictureDifference result;
    result.width = static_cast<std::size_t>(a.width);
    result.height = static_cast<std::size_t>(a.height);
    result.flip_map = measure::flip(measure::to_unrounded_display(a, exposure),
                                    measure::to_unrounded_display(b, exposure), pixels_per_degree);
    result.metrics = measure::difference(apply_exposure(std::move(a), exposure),
                                         apply_exposure(std::move(b), exposure), mask,
                                         result.flip_map);
    return result;
}

void bind_difference(nb::module_& module) {
    using Result = PictureDifference;
    nb::class_<Result>(module, "Difference",
                       "The difference of two pictures over the pixels of a mask.\n\n"
                       "All metrics but `flip` compare linear RGB after exposure, clamped to [0, "
                       "1].\nA metric is NaN if no pixel is finite.")
        .def_prop_ro(
            "flip", [](const Result& r) { return r.metrics.flip; },
            "The mean of the FLIP map, 0 to 1.")
        .def_prop_ro(
            "rmse", [](const Result& r) { return r.metrics.rmse; },
            "The root of the mean square over pixels and channels, 0 to 1.")
        .def_prop_ro(
            "mae", [](const Result& r) { return r.metrics.mae; },
            "The mean absolute difference over pixels and channels, 0 to 1.")
        .def_prop_ro(
            "psnr", [](const Result& r) { return r.metrics.psnr; },
            "-20 log10 rmse, dB. None if rmse is 0 or NaN.")
        .def_prop_ro(
            "p99", [](const Result& r) { return r.metrics.p99; },
            "The 99th percentile of the pixels' largest channel difference, 0 to 1.")
        .def_prop_ro(
            "max", [](const Result& r) { return r.metrics.max; },
            "The largest channel difference, 0 to 1.")
        .def_prop_ro(
            "max_at", [](const Result& r) { return std::tuple(r.metrics.max_y, r.metrics.max_x); },
            "Row and column of the first pixel with the largest difference, or (-1, -1).")
        .def_prop_ro(
            "off", [](const Result& r) { return r.metrics.off; },
            "The share of pixels with a channel that differs by more than .02, 0 to 1.")
        .def_prop_ro(
            "pixels", [](const Result& r) { return r.metrics.pixels; },
            "The number of pixels of the mask.")
        .def_prop_ro(
            "nonfinite", [](const Result& r) { return r.metrics.nonfinite; },
            "The number of pixels with a NaN or infinity, which the metrics leave out.")
        .def_prop_ro(
            "flip_map",
            [](nb::handle_t<Result> self) {
                Result& r = nb::cast<Result&>(self);
                return MapArray(r.flip_map.data(), {r.height, r.width}, self);
            },
            "The FLIP map: shape (height, width), float32, 0 to 1. Shares the object's memory.")
        .def("__repr__", [](const Result& r) {
            return "Difference(flip=" + std::to_string(r.metrics.flip) +
                   ", rmse=" + std::to_string(r.metrics.rmse) + ")";
        });
    module.def("diff", &compare_pictures, nb::arg("a"), nb::arg("b"), nb::kw_only(),
               nb::arg("exposure") = 0.0, nb::arg("mask") = nb::none(),
               nb::arg("pixels_per_degree") = 67.0,
               "Returns the difference of two pictures. Its metrics are symmetric.\n\n"
               "Args:\n"
               "    a, b: Pictures in linear light, shape (height, width, 3).\n"
               "    exposure: Stops. Both pictures are multiplied by 2**exposure first.\n"
               "    mask: The pixels that count, shape (height, width), bool. None: all pixels.\n"
               "    pixels_per_degree: The viewing distance for FLIP, 1 to 1000.\n\n"
               "Raises:\n"
               "    BadData: The pictures or the mask differ in size, or have no pixel.\n"
               "    UsageError: pixels_per_degree is out of range.");
}

} // namespace

PictureArray share_picture(measure::Picture& picture, nb::handle owner) {
    return PictureArray(
        picture.pixels.data(),
        {static_cast<std::size_t>(picture.height), static_cast<std::size_t>(picture.width), 3},
        owner);
}

PictureArray own_picture(measure::Picture&& picture) {
    auto kept = std::make_unique<measure::Picture>(std::move(picture));
    measure::Picture& memory = *kept;
    const nb::capsule owner(kept.release(), [](void* pointer) noexcept {
        delete static_cast<measure::Picture*>(pointer);
    });
    return share_picture(memory, owner);
}

measure::Picture copy_picture(const PictureArgument& array) {
    constexpr std::size_t kMaxSide = 1 << 20;
    if (array.shape(0) > kMaxSide || array.shape(1) > kMaxSide)
        throw UsageError("picture: wanted at most 1048576 rows and columns, found the shape (" +
                         std::to_string(array.shape(0)) + ", " + std::to_string(array.shape(1)) +
                         ", 3)");
    measure::Picture picture(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
    if (array.size() > 0) std::memcpy(picture.pixels.data(), array.data(), array.nbytes());
    return picture;
}

void bind_pictures(nb::module_& module) {
    bind_difference(module);
    module.def(
        "read_picture",
        [](const std::filesystem::path& path) {
            measure::Picture picture;
            {
                const nb::gil_scoped_release released;
                picture = measure::read_picture(path);
            }
            return own_picture(std::move(picture));
        },
        nb::arg("path"),
        "Reads an OpenEXR, Radiance .hdr or PNG file as linear light.\n\n"
        "Returns:\n"
        "    An array of shape (height, width, 3), float32. Values of an OpenEXR file are taken\n"
        "    as they are. PNG files are decoded with the sRGB curve.\n\n"
        "Raises:\n"
        "    MissingInput: The file does not exist.\n"
        "    BadData: The file is no such picture.");
    module.def(
        "to_display",
        [](const PictureArgument& array, double exposure) {
            return own_picture(measure::to_display(copy_picture(array), exposure));
        },
        nb::arg("picture"), nb::arg("exposure") = 0.0,
        "Returns a picture as a display shows it.\n\n"
        "Args:\n"
        "    picture: Linear light, shape (height, width, 3).\n"
        "    exposure: Stops.\n\n"
        "Returns:\n"
        "    picture * 2**exposure, clamped to [0, 1] and through the sRGB curve. The shape is\n"
        "    (height, width, 3), and values are multiples of 1/255. NaN becomes 0.");
    module.def(
        "encode_png",
        [](const PictureArgument& array, double exposure) {
            const std::string file = measure::encode_png(
                measure::to_display(copy_picture(array), exposure));
            return nb::bytes(file.data(), file.size());
        },
        nb::arg("picture"), nb::arg("exposure") = 0.0,
        "Returns a PNG file with 8 bits a channel, such as for IPython.display.Image.\n\n"
        "Args:\n"
        "    picture: Linear light, shape (height, width, 3).\n"
        "    exposure: Stops.");
    module.def(
        "write_png",
        [](const PictureArgument& array, const std::filesystem::path& path, double exposure) {
            measure::write_png(measure::to_display(copy_picture(array), exposure), path);
        },
        nb::arg("picture"), nb::arg("path"), nb::arg("exposure") = 0.0,
        "Writes a PNG file with 8 bits a channel. Replaces the file as a whole or not at all.\n\n"
        "Args:\n"
        "    picture: Linear light, shape (height, width, 3).\n"
        "    path: The file.\n"
        "    exposure: Stops.\n\n"
        "Raises:\n"
        "    CannotCreate, IoError: The file cannot be written.");
    module.def(
        "write_exr",
        [](const PictureArgument& array, const std::filesystem::path& path) {
            measure::write_exr(copy_picture(array), path);
        },
        nb::arg("picture"), nb::arg("path"),
        "Writes an OpenEXR file with each 32-bit value as it is. Replaces the file as a whole or "
        "not at all.\n\n"
        "Args:\n"
        "    picture: Linear light, shape (height, width, 3).\n"
        "    path: The file.\n\n"
        "Raises:\n"
        "    CannotCreate, IoError: The file cannot be written.");
}

} // namespace catoptric::python
