#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "app/program.hpp"
#include "cloud2csg/view.hpp"

namespace cloud2csg::test {
namespace {

class Reports : public ProgramTest {
 protected:
  void SetUp() override {
    if (!has_report_page()) GTEST_SKIP() << "built without Node.js: there is no page";
  }

  /// A running `view` and the port that it says.
  struct Served {
    RunningProgram program;
    int port;
  };
  Served serve(const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"view", shipped("m1.json"), "--no-browser"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    RunningProgram program = start(arguments);
    std::string address;
    // Sanitized and beside other work, the page takes a while.
    for (int k = 0; k < 20000 && address.find('\n') == std::string::npos; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      address = program.out_so_far();
    }
    constexpr std::string_view k_begin = "http://127.0.0.1:";
    EXPECT_TRUE(address.starts_with(k_begin)) << address << program.err_so_far();
    return {.program = program, .port = address.empty() ? 1 : std::stoi(address.substr(k_begin.size()))};
  }
};

TEST_F(Reports, AreWrittenByExtractAndConvert) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "3000", "--noise", "0.01", "-o", path("m.ply")}).status, 0);
  const Outcome extracted = run({"extract", path("m.ply"), "--primitives", shipped("m1.json"), "-o", path("m.scad"),
                                 "-o", path("m.html"), "--seed", "5"});
  ASSERT_EQ(extracted.status, 0) << extracted.err;
  EXPECT_TRUE(read_file(path("m.html")).starts_with("<!doctype html>"));
  ASSERT_EQ(run({"convert", shipped("m1.json"), "-o", path("c.html")}).status, 0);
  EXPECT_TRUE(read_file(path("c.html")).starts_with("<!doctype html>"));
  EXPECT_LT(read_file(path("c.html")).size(), read_file(path("m.html")).size());
}

TEST_F(Reports, NeedATree) {
  const std::string model = file("p.json", R"({"format": "cloud2csg", "version": 1, "primitives": [
    {"id": "a", "type": "sphere", "pose": {"position": [0, 0, 0], "quaternion": [1, 0, 0, 0]}, "radius": 1}]})");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"convert", model, "-o", path("x.html")}, {"view", model, "--no-browser"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("/tree"), std::string::npos) << outcome.err;
  }
}

TEST_F(Reports, AreServedUntilInterrupted) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "500", "-o", path("m.ply")}).status, 0);
  Served served = serve({"--cloud", path("m.ply"), "--quiet"});
  httplib::Client client("127.0.0.1", served.port);
  const auto page = client.Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_TRUE(page->body.starts_with("<!doctype html>"));
  EXPECT_EQ(page->get_header_value("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(client.Get("/", {{"Host", "localhost:" + std::to_string(served.port)}})->status, 200);
  served.program.send_signal(SIGINT);
  const Outcome outcome = served.program.wait();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_FALSE(client.Get("/"));
}

/// Who connects and says nothing does not keep the program from ending.
TEST_F(Reports, EndsBesideAConnectionThatIsSilent) {
  Served served = serve({"--quiet"});
  const int silent = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(served.port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::connect(silent, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(httplib::Client("127.0.0.1", served.port).Get("/")->status, 200);
  served.program.send_signal(SIGINT);
  EXPECT_EQ(served.program.wait().status, 0);
  ::close(silent);
}

TEST_F(Reports, SayWhenNoBrowserOpens) {
  const std::string browser = file("xdg-open", "#!/bin/sh\nexit 3\n");
  std::filesystem::permissions(browser, std::filesystem::perms::owner_all);
  const std::string setup = "export DISPLAY=:7 PATH=" + folder().string() + ":$PATH";
  RunningProgram program = start({"view", shipped("m1.json")}, setup);
  for (int k = 0; k < 20000 && program.err_so_far().find("Ctrl-C") == std::string::npos; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  program.send_signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_NE(outcome.err.find("open this address in a browser"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("opened in the browser"), std::string::npos) << outcome.err;
}

TEST_F(Reports, NothingElseIsServed) {
  Served served = serve({});
  httplib::Client client("127.0.0.1", served.port);
  const std::string own = "127.0.0.1:" + std::to_string(served.port);
  for (const std::string& host : {std::string("evil.example"), "evil.example:" + std::to_string(served.port),
                                  std::string("127.0.0.1"), std::string("127.0.0.1:1"), own + ".evil.example"}) {
    const auto answer = client.Get("/", {{"Host", host}});
    ASSERT_TRUE(answer) << host;
    EXPECT_EQ(answer->status, 403) << host;
    EXPECT_EQ(answer->body, "") << host;
  }
  for (const char* place : {"/etc/passwd", "/index.html", "/../etc/passwd", "//", "/%2e%2e/etc/passwd"}) {
    const auto answer = client.Get(place);
    ASSERT_TRUE(answer) << place;
    EXPECT_EQ(answer->status, 404) << place;
    EXPECT_EQ(answer->body, "") << place;
  }
  EXPECT_EQ(client.Post("/", "x", "text/plain")->status, 405);
  EXPECT_EQ(client.Delete("/")->status, 405);
  EXPECT_EQ(client.Get("/")->status, 200);
  const Outcome second = run({"view", shipped("m1.json"), "--no-browser", "--port", std::to_string(served.port)});
  EXPECT_EQ(second.status, 1);
  EXPECT_NE(second.err.find("the port cannot be opened"), std::string::npos) << second.err;
  served.program.send_signal(SIGTERM);
  EXPECT_EQ(served.program.wait().status, 0);
}

}  // namespace
}  // namespace cloud2csg::test
