#pragma once

/// Marks a function whose loops are also compiled for processors with AVX2. The version is chosen
/// at run time. Both versions give the same bits, because no product is fused with a sum.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define CATOPTRIC_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define CATOPTRIC_WIDE
#endif
