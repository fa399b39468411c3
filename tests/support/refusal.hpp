#pragma once

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

/// Functions that expect an error.
namespace test {

/// Runs `action`, which must throw an error of this kind, and returns the error's text. Fails the
/// test if nothing is thrown.
inline std::string catch_error_text(catoptric::Failure failure,
                                    const std::function<void()>& action) {
    try {
        action();
    } catch (const catoptric::Error& error) {
        EXPECT_EQ(error.failure, failure) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
}

/// Expects that `action` throws an error of this kind whose text contains each of `words`.
inline void expect_error(const std::function<void()>& action, catoptric::Failure failure,
                         const std::vector<std::string>& words) {
    const std::string text = catch_error_text(failure, action);
    for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos)
            << "'" << text << "' does not say '" << word << "'";
}

} // namespace test
