#include "loop.hpp"

int main(int argc, char** argv) { return catoptric::view::run_view(argc, argv); }
