#include "program.hpp"

int main(int argc, char** argv) { return catoptric::cli::run_program(argc, argv); }
