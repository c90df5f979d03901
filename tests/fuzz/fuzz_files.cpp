// Damages good files of each format and has all readers read them: each must give a result or throw Error, with a
// message that is one short line. `fuzz_files [--mutants COUNT] [--program PATH]`; mutant and seed are functions of its
// number alone. With a program, `PROGRAM info FILE` must end with status 0, 1 or 2 on one mutant of 50.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "fuzz/mutate.hpp"
#include "fuzz/seeds.hpp"

namespace cloud2csg::fuzz {
namespace {

constexpr rlim_t k_seconds = 20;  // of the processor, a file
constexpr rlim_t k_memory = rlim_t{4} << 30U;
constexpr std::size_t k_program_every = 50;
constexpr std::size_t k_longest_message = 200;

// How a worker ends that came to its end.
constexpr int k_all_good = 0;
constexpr int k_some_bad = 42;

struct Options {
  std::size_t mutants = 2000;
  std::string program = {};
  /// Of a worker: the first mutant, and where files go.
  std::size_t first = 0;
  std::optional<std::filesystem::path> folder = {};
};

[[noreturn]] void refuse_usage() {
  fmt::print(stderr, "usage: fuzz_files [--mutants COUNT] [--program PATH]\n");
  std::exit(2);
}

Options parse_options(const std::vector<std::string>& words) {
  Options options;
  for (std::size_t i = 0; i < words.size(); i += 2) {
    if (i + 1 == words.size()) refuse_usage();
    if (words[i] == "--mutants") {
      options.mutants = std::stoul(words[i + 1]);
    } else if (words[i] == "--program") {
      options.program = words[i + 1];
    } else if (words[i] == "--first") {
      options.first = std::stoul(words[i + 1]);
    } else if (words[i] == "--folder") {
      options.folder = words[i + 1];
    } else {
      refuse_usage();
    }
  }
  return options;
}

/// Runs a program with limits. @returns as waitpid() has it
int run_program(const std::vector<std::string>& words, bool is_quiet) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));  // NOLINT: as exec has it
  arguments.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    if (is_quiet) {
      const rlimit seconds{k_seconds, k_seconds};
      ::setrlimit(RLIMIT_CPU, &seconds);
      ::alarm(30 * k_seconds);  // of one that sleeps
      if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr)
        _exit(127);
    }
    ::execv(arguments.front(), arguments.data());
    _exit(127);
  }
  int status = 0;
  while (child < 0 || (::waitpid(child, &status, 0) < 0 && errno == EINTR)) {
    if (child < 0) std::abort();
  }
  return status;
}

std::string told(int status) {
  if (WIFSIGNALED(status)) return fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

/// What is wrong with a message; empty when nothing is.
std::string fault_of(const Error& error) {
  const std::string message = error.what();
  const std::size_t beside_file = message.size() - error.parts().file.size();
  if (error.parts().file.empty()) return "a message without the file: " + message;
  if (beside_file > k_longest_message) return fmt::format("a message of {} bytes: {}", beside_file, message);
  if (std::ranges::any_of(message, [](char c) { return c >= 0 && c < ' '; })) return "controls in a message";
  return {};
}

/// What is wrong with a use of a file; empty when nothing is.
template <typename Use>
std::string fault_in(const Use& use) {
  try {
    use();
    return {};
  } catch (const Error& error) {
    return fault_of(error);
  } catch (const std::exception& error) {
    return fmt::format("another exception than Error: {}", error.what());
  }
}

std::string fault_in_reading(const std::filesystem::path& file) {
  std::string fault = fault_in([&] {
    const Shape3d shape = read_shape(file);
    if (shape.mesh && is_watertight(*shape.mesh)) (void)volume_of(*shape.mesh);
  });
  const std::string ending = file.extension().string();
  if (!fault.empty() || ending == ".json" || ending == ".scad" || ending == ".csg") return fault;
  return fault_in([&] { (void)read_cloud_or_mesh(file, {.mesh_points = 100}); });
}

void limit_this_process() {
#ifndef CLOUD2CSG_HAS_SANITIZERS  // which take all addresses there are
  const rlimit memory{k_memory, k_memory};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
}

/// SIGPROF ends the process after so much time of the processor from now on.
void start_clock() {
  const itimerval limit{.it_interval = {}, .it_value = {.tv_sec = k_seconds, .tv_usec = 0}};
  ::setitimer(ITIMER_PROF, &limit, nullptr);
}

/// Mutants from the first on. The file of one that ends the process stays, with its number for a name.
int work(const Options& options) {
  const std::vector<Seed> seeds = make_seeds(*options.folder);
  limit_this_process();
  int status = k_all_good;
  for (std::size_t i = options.first; i < options.mutants; ++i) {
    Seed seed = seeds[i % seeds.size()];
    RandomStream random(1, 0, i);
    if (i >= seeds.size()) seed.bytes = mutated(std::move(seed.bytes), random);  // the first are the seeds themselves
    const std::filesystem::path file = *options.folder / (std::to_string(i) + seed.ending);
    std::ofstream(file, std::ios::binary) << (seed.pack != nullptr ? seed.pack(seed.bytes) : seed.bytes);
    start_clock();
    std::string fault = fault_in_reading(file);
    if (i < seeds.size()) (void)read_shape(file);  // is a good file
    if (fault.empty() && !options.program.empty() && i % k_program_every == 0) {
      const int ended = run_program({options.program, "info", file.string()}, true);
      if (!WIFEXITED(ended) || WEXITSTATUS(ended) > 2) fault = "the program " + told(ended);
    }
    if (fault.empty()) {
      std::filesystem::remove(file);
      continue;
    }
    fmt::print(stderr, "{}: {}\n", (*options.folder / "bad" / file.filename()).string(), fault);
    std::filesystem::rename(file, *options.folder / "bad" / file.filename());
    status = k_some_bad;
  }
  return status;
}

/// Has workers do it, a new one after a mutant that ended one. @returns whether all was well
bool supervise(Options options) {
  std::string name = (std::filesystem::temp_directory_path() / "cloud2csg_fuzz_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const std::filesystem::path folder = name;
  std::filesystem::create_directory(folder / "bad");
  bool is_well = true;
  while (options.first < options.mutants) {
    const int status = run_program({"/proc/self/exe", "--mutants", std::to_string(options.mutants), "--first",
                                    std::to_string(options.first), "--folder", name, "--program", options.program},
                                   false);
    is_well = is_well && status == 0;
    if (WIFEXITED(status) && (WEXITSTATUS(status) == k_all_good || WEXITSTATUS(status) == k_some_bad)) break;
    const std::filesystem::directory_iterator files(folder);
    const auto last = std::ranges::find_if(files, [](const auto& entry) { return entry.is_regular_file(); });
    if (last == std::filesystem::directory_iterator()) throw std::runtime_error("a worker " + told(status));
    const std::filesystem::path file = last->path();
    fmt::print(stderr, "{}: the worker {}\n", (folder / "bad" / file.filename()).string(), told(status));
    options.first = std::stoul(file.stem().string()) + 1;
    std::filesystem::rename(file, folder / "bad" / file.filename());
  }
  if (is_well) std::filesystem::remove_all(folder);
  return is_well;
}

}  // namespace
}  // namespace cloud2csg::fuzz

int main(int argc, char** argv) {
  using namespace cloud2csg::fuzz;
  try {
    const Options options = parse_options({argv + 1, argv + argc});
    if (options.folder) return work(options);
    if (!supervise(options)) return 1;
    fmt::print("{} files: each was read, or refused in a line\n", options.mutants);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz_files: {}\n", error.what());
    return 1;
  }
}
