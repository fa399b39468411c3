// Linked only into programs of the asan preset. The Vulkan loader unloads drivers and layers before
// the leak check, which then cannot name their functions. Without dlclose, drivers and layers stay
// loaded, so their own leaks can be suppressed by module.
extern "C" int dlclose(void*) { return 0; }

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libvulkan_lvp.so\nleak:libVkLayer_khronos_validation.so\nleak:libLLVM\nleak:"
           "libvulkan.so\nleak:libOpenImageIO\n";
}
