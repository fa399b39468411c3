#include "measure/plane.hpp"

namespace catoptric::measure {

Plane along_x(const Plane& in, const Kernel& kernel) {
    Plane out(in.width, in.height);
    for_rows(in.height, [&](int y) {
        const double* from = in.row(y);
        std::vector<double> padded(static_cast<std::size_t>(in.width + 2 * kernel.radius));
        for (int i = 0; i < static_cast<int>(padded.size()); ++i)
            padded[static_cast<std::size_t>(i)] =
                from[std::clamp(i - kernel.radius, 0, in.width - 1)];
        for (int offset = -kernel.radius; offset <= kernel.radius; ++offset) {
            const double weight = kernel[offset];
            const double* shifted = padded.data() + kernel.radius + offset;
            double* to = out.row(y);
            for (int x = 0; x < in.width; ++x) to[x] += weight * shifted[x];
        }
    });
    return out;
}

Plane along_y(const Plane& in, const Kernel& kernel) {
    Plane out(in.width, in.height);
    for_rows(in.height, [&](int y) {
        double* to = out.row(y);
        for (int offset = -kernel.radius; offset <= kernel.radius; ++offset) {
            const double weight = kernel[offset];
            const double* from = in.row(std::clamp(y + offset, 0, in.height - 1));
            for (int x = 0; x < in.width; ++x) to[x] += weight * from[x];
        }
    });
    return out;
}

} // namespace catoptric::measure
