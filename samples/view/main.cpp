#include "catoptric/signals.hpp"
#include "loop.hpp"

namespace {

/// Runs before all constructors of the program. In `main`, signals would be handled too late.
[[gnu::constructor(101)]] void run_before_constructors() {
    catoptric::cli::exit_on_signals("catoptric-view");
}

} // namespace

int main(int argc, char** argv) { return catoptric::view::run_program(argc, argv); }
