#pragma once

#include <cstdio>
#include <exception>

namespace cloud2csg::bench {

/// The main function of a program that prints tables: its exit status is that of run(argc, argv), or 1 after an error,
/// which it prints. Tables appear one by one, also in a file.
template <typename Run>
int run_main(int argc, char** argv, const Run& run) {
  try {
    (void)std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    return run(argc, argv);
  } catch (const std::exception& error) {
    (void)std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace cloud2csg::bench
