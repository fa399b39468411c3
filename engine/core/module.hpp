#pragma once

#include <cstddef>

namespace catoptric {

/// A library of this project that programs load only when they need it. The reason is that it links
/// many other libraries, or libraries whose symbols conflict with others.
struct Module {
    const char* file_name;
    std::size_t address_space; ///< bytes that the module and its libraries take
    const char* library;       ///< the library that it links, for messages
    const char* without;       ///< what is not possible without it: "pictures cannot be read"
    const char* requirement;   ///< the end of a sentence, which says what to install
    const char* symbol;        ///< the only symbol that the module exports
};

/// Loads a module and returns the address of its symbol. The module is searched beside the library
/// or program that contains this code, and at its installed place relative to them. Throws
/// `internal` with the searched places and what to install, or `exhausted` without memory.
void* load_symbol(const Module& module);

} // namespace catoptric
