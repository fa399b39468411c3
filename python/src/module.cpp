// The module `_catoptric`: techniques, and exceptions.
#include "binding.hpp"

#include <catoptric/error.hpp>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

namespace catoptric::python {

namespace {

const char* find_exception_name(Failure failure) {
    switch (failure) {
    case Failure::usage: return "UsageError";
    case Failure::bad_data: return "BadData";
    case Failure::missing_input: return "MissingInput";
    case Failure::no_device: return "NoDevice";
    case Failure::internal: return "InternalError";
    case Failure::cannot_create: return "CannotCreate";
    case Failure::io: return "IoError";
    case Failure::exhausted: return "Exhausted";
    case Failure::device_lost: return "DeviceLost";
    default: return "Error";
    }
}

void raise_exception(const std::exception_ptr& thrown, void*) {
    try {
        std::rethrow_exception(thrown);
    } catch (const Error& error) {
        const nb::object type =
            nb::module_::import_("catoptric._errors").attr(find_exception_name(error.failure));
        nb::object exception = type(error.what());
        exception.attr("failure") = static_cast<int>(error.failure);
        PyErr_SetObject(type.ptr(), exception.ptr());
    }
}

void bind_techniques(nb::module_& module) {
    nb::class_<session::KnobInfo>(module, "Knob", "A setting of a technique.")
        .def_ro("name", &session::KnobInfo::name)
        .def_ro("help", &session::KnobInfo::help)
        .def_ro("low", &session::KnobInfo::low, "The lowest value of a number.")
        .def_ro("high", &session::KnobInfo::high, "The highest value of a number.")
        .def_ro("value", &session::KnobInfo::value, "The default, as text.")
        .def_ro("choices", &session::KnobInfo::choices, "The allowed words; empty for a number.")
        .def_ro("special", &session::KnobInfo::special,
                "A word that is allowed in place of the number; empty: none.")
        .def("__repr__", [](const session::KnobInfo& knob) {
            return "Knob('" + knob.name + "=" + knob.value + "')";
        });
    nb::class_<session::TechniqueInfo>(module, "Technique", "A way to render reflections.")
        .def_ro("name", &session::TechniqueInfo::name)
        .def_ro("summary", &session::TechniqueInfo::summary, "One sentence.")
        .def_ro("knobs", &session::TechniqueInfo::knobs)
        .def("__repr__", [](const session::TechniqueInfo& technique) {
            return "Technique('" + technique.name + "')";
        });
    module.def("techniques", &session::techniques,
               "Returns every technique, in the order of the technique table.");
}

} // namespace

NB_MODULE(_catoptric, module) {
    module.doc() = "Binds the C++ library. Use the package `catoptric` instead.";
    nb::register_exception_translator(raise_exception);
    bind_techniques(module);
    bind_scenes(module);
    bind_pictures(module);
    bind_frames(module);
    bind_comparisons(module);
    module.def("version", &session::version,
               "Returns the version of the library, such as '0.1.0'.");
    module.def("commit", &session::commit,
               "Returns the abbreviated commit of the library, or 'unknown'.");
    module.def("has_abandoned_device", &session::has_abandoned_device,
               "Returns whether an engine of this process had to give up its device.\n\n"
               "Threads of the driver may then still run, so end the program by os._exit().");
}

} // namespace catoptric::python
