#pragma once

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

/// Errors that a test asks for.
namespace test {

/// What the error says that comes out of `action`, which is to be of this kind; without one the
/// test fails.
inline std::string refusal(catoptric::Failure failure, const std::function<void()>& action) {
    try {
        action();
    } catch (const catoptric::Error& error) {
        EXPECT_EQ(error.failure, failure) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
}

/// Expects `Error(failure)` whose text holds every one of the words.
inline void expect_refused(const std::function<void()>& action, catoptric::Failure failure,
                           const std::vector<std::string>& words) {
    const std::string text = refusal(failure, action);
    for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos)
            << "'" << text << "' does not say '" << word << "'";
}

} // namespace test
