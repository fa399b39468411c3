#include "gpu/shader.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <vulkan/vulkan.h>

namespace catoptric::gpu {

namespace {

// The parts of SPIR-V that are read (specification 1.6, sections 3.20, 3.42, 3.49).
enum SpirvOp : std::uint32_t {
    kName = 5,
    kCapability = 17,
    kTypeInt = 21,
    kTypeFloat = 22,
    kTypeVector = 23,
    kTypeMatrix = 24,
    kTypeImage = 25,
    kTypeSampler = 26,
    kTypeSampledImage = 27,
    kTypeArray = 28,
    kTypeRuntimeArray = 29,
    kTypeStruct = 30,
    kTypePointer = 32,
    kConstant = 43,
    kFunctionCall = 57,
    kVariable = 59,
    kImageTexelPointer = 60,
    kLoad = 61,
    kAccessChain = 65,
    kInBoundsAccessChain = 66,
    kArrayLength = 68,
    kDecorate = 71,
    kMemberDecorate = 72,
};
enum SpirvDecoration : std::uint32_t {
    kSpecId = 1,
    kLocation = 30,
    kBinding = 33,
    kDescriptorSet = 34,
    kOffset = 35
};
enum SpirvStorageClass : std::uint32_t {
    kUniformConstant = 0,
    kInput = 1,
    kUniform = 2,
    kPushConstant = 9,
    kStorageBuffer = 12
};
// Numbers of SPIR-V capabilities.
constexpr std::uint32_t kGeometryCapability = 2, kFloat64Capability = 10;
enum SpirvImageDimension : std::uint32_t { kDim2D = 1, kDimCube = 3, kDimBuffer = 5 };

struct SpirvType {
    std::uint32_t op = 0;
    std::vector<std::uint32_t> words; // operands after the result id
};
struct SpirvVariable {
    std::uint32_t id = 0, type = 0, storage = 0;
};

class SpirvModule {
public:
    SpirvModule(std::string_view name, std::span<const std::uint32_t> words) : name_(name) {
        check(words.size() > 5 && words[0] == 0x07230203, Failure::internal, "shader '", name,
              "' is not SPIR-V");
        for (std::size_t i = 5; i < words.size();) {
            const std::uint32_t length = words[i] >> 16;
            check(length > 0 && i + length <= words.size(), Failure::internal, "shader '", name,
                  "' is cut off");
            read_instruction(words[i] & 0xffff, words.subspan(i + 1, length - 1));
            i += length;
        }
    }

    ShaderReflection make_reflection() const {
        ShaderReflection result;
        for (const SpirvVariable& variable : variables_) {
            if (variable.storage == kInput && decoration(variable.id, kLocation))
                result.has_inputs = true;
            if (variable.storage == kPushConstant)
                result.push_bytes = std::max(result.push_bytes, byte_size(pointee_type(variable)));
            else if (used_.contains(variable.id) && decoration(variable.id, kBinding))
                result.bindings.push_back(make_binding(variable));
        }
        for (const auto& [key, value] : decorations_)
            if (key.second == kSpecId) result.constants.push_back({debug_name(key.first), value});
        result.doubles = doubles_, result.triangle_numbers = triangle_numbers_;
        std::ranges::sort(result.bindings, {}, &ShaderBinding::binding);
        return result;
    }

private:
    void read_instruction(std::uint32_t op, std::span<const std::uint32_t> words) {
        switch (op) {
        case kName: names_[words[0]] = reinterpret_cast<const char*>(words.data() + 1); break;
        case kCapability:
            doubles_ = doubles_ || words[0] == kFloat64Capability;
            triangle_numbers_ = triangle_numbers_ || words[0] == kGeometryCapability;
            break;
        case kDecorate:
            if (words.size() > 2) decorations_[{words[0], words[1]}] = words[2];
            break;
        case kMemberDecorate:
            if (words[2] == kOffset) member_offsets_[{words[0], words[1]}] = words[3];
            break;
        case kTypeInt:
        case kTypeFloat:
        case kTypeVector:
        case kTypeMatrix:
        case kTypeImage:
        case kTypeSampler:
        case kTypeSampledImage:
        case kTypeArray:
        case kTypeRuntimeArray:
        case kTypeStruct:
        case kTypePointer: types_[words[0]] = {op, {words.begin() + 1, words.end()}}; break;
        case kConstant: constants_[words[1]] = words[2]; break;
        case kVariable: variables_.push_back({words[1], words[0], words[2]}); break;
        case kLoad:
        case kAccessChain:
        case kInBoundsAccessChain:
        case kImageTexelPointer:
        case kArrayLength: used_.insert(words[2]); break;
        case kFunctionCall: used_.insert(words.begin() + 3, words.end()); break;
        default: break;
        }
    }

    std::optional<std::uint32_t> decoration(std::uint32_t id, std::uint32_t which) const {
        const auto found = decorations_.find({id, which});
        return found == decorations_.end() ? std::nullopt : std::optional(found->second);
    }
    std::string debug_name(std::uint32_t id) const {
        const auto found = names_.find(id);
        return found == names_.end() ? "" : found->second;
    }
    std::uint32_t pointee_type(const SpirvVariable& variable) const {
        return types_.at(variable.type).words[1];
    }

    /// Returns the bytes of a type in the scalar layout.
    std::uint32_t byte_size(std::uint32_t id) const {
        const SpirvType& type = types_.at(id);
        switch (type.op) {
        case kTypeInt:
        case kTypeFloat: return type.words[0] / 8;
        case kTypeVector:
        case kTypeMatrix: return byte_size(type.words[0]) * type.words[1];
        case kTypeArray: return byte_size(type.words[0]) * constants_.at(type.words[1]);
        case kTypeStruct: {
            if (type.words.empty()) return 0;
            const auto last = static_cast<std::uint32_t>(type.words.size() - 1);
            return member_offsets_.at({id, last}) + byte_size(type.words[last]);
        }
        default: fail(Failure::internal, "shader '", name_, "': a push constant of unknown size");
        }
    }

    ShaderBinding make_binding(const SpirvVariable& variable) const {
        ShaderBinding result;
        result.name = debug_name(variable.id);
        result.binding = *decoration(variable.id, kBinding);
        check(decoration(variable.id, kDescriptorSet).value_or(0) == 0, Failure::internal,
              "shader '", name_, "': '", result.name, "' is not in set 0");
        const SpirvType* type = &types_.at(pointee_type(variable));
        if (type->op == kTypeStruct) {
            if (result.name.empty()) result.name = debug_name(pointee_type(variable));
            result.kind = variable.storage == kUniform ? BindingKind::uniform_buffer
                                                       : BindingKind::storage_buffer;
            return result;
        }
        if (type->op == kTypeSampler) {
            result.kind = BindingKind::sampler;
            return result;
        }
        const bool is_array = type->op == kTypeArray;
        if (is_array) {
            result.count = constants_.at(type->words[1]);
            type = &types_.at(type->words[0]);
        }
        check(type->op == kTypeImage || type->op == kTypeSampledImage, Failure::internal,
              "shader '", name_, "': '", result.name,
              "' is neither an image nor an array of textures with a size");
        const bool has_sampler = type->op == kTypeSampledImage;
        if (has_sampler) type = &types_.at(type->words[0]);
        const std::uint32_t dim = type->words[1], arrayed = type->words[3],
                            sampled = type->words[5];
        result.kind = dim == kDimBuffer ? BindingKind::texel_buffer
                      : sampled == 2    ? BindingKind::storage_image
                      : has_sampler     ? BindingKind::sampled_image
                                        : BindingKind::texture;
        check(!is_array || result.kind == BindingKind::texture, Failure::internal, "shader '",
              name_, "': '", result.name, "' is an array of something else than textures");
        result.shape = dim == kDimCube
                           ? (arrayed ? ImageViewType::cube_array : ImageViewType::cube)
                           : (arrayed ? ImageViewType::flat_array : ImageViewType::flat);
        return result;
    }

    std::string_view name_;
    std::map<std::uint32_t, std::string> names_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> decorations_, member_offsets_;
    std::map<std::uint32_t, SpirvType> types_;
    std::map<std::uint32_t, std::uint32_t> constants_;
    std::vector<SpirvVariable> variables_;
    std::set<std::uint32_t> used_;
    bool doubles_ = false, triangle_numbers_ = false;
};

} // namespace

namespace {

std::map<std::string_view, EmbeddedShader>& added_shaders() {
    static std::map<std::string_view, EmbeddedShader> shaders; // filled while the program starts
    return shaders;
}

const EmbeddedShader* find_embedded_shader(std::string_view name) {
    const auto shaders = embedded_shaders();
    const auto found = std::ranges::find(shaders, name, &EmbeddedShader::name);
    if (found != shaders.end()) return &*found;
    const auto other = added_shaders().find(name);
    return other == added_shaders().end() ? nullptr : &other->second;
}

} // namespace

void add_shader(const EmbeddedShader& shader) {
    check(!find_embedded_shader(shader.name), Failure::usage, "there is a shader '", shader.name,
          "' already");
    added_shaders().emplace(shader.name, shader);
}

const EmbeddedShader& find_shader(std::string_view name) {
    const EmbeddedShader* found = find_embedded_shader(name);
    check(found, Failure::internal, "there is no shader '", name, "'");
    return *found;
}

ShaderReflection reflect_spirv(std::string_view name, std::span<const std::uint32_t> words) {
    return SpirvModule(name, words).make_reflection();
}

} // namespace catoptric::gpu
