#include "program.hpp"
#include "signals.hpp"

namespace {

/// Before any object of the program is made; main would be later by all of them.
[[gnu::constructor(101)]] void begin() { catoptric::cli::answer_signals("catoptric"); }

} // namespace

int main(int argc, char** argv) { return catoptric::cli::run_program(argc, argv); }
