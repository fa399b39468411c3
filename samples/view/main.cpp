#include "catoptric/signals.hpp"
#include "loop.hpp"

namespace {

/// Before any object of the program is made; main would be later by all of them.
[[gnu::constructor(101)]] void begin() { catoptric::cli::answer_signals("catoptric-view"); }

} // namespace

int main(int argc, char** argv) { return catoptric::view::run_view(argc, argv); }
