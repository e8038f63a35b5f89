// SPDX-License-Identifier: Apache-2.0
//
// The scene reader on any text: it throws a SceneError of one line that is not empty, or the scene survives a round
// trip: read, write, read is equal, and the second writing is the first. What was read and can be drawn is a valid
// frame.
#include <string>
#include <string_view>

#include "corpus/scene.hpp"
#include "fuzz/finding.hpp"

namespace surefill::fuzz {
namespace {

[[noreturn]] void fail(const std::string& relation, std::string_view text) {
  report_finding("reader", relation, std::string(text) + "\n");
}

void check_message(const corpus::SceneError& error, std::string_view text) {
  const std::string_view message = error.what();
  if (message.empty()) fail("the error has no message", text);
  if (message.find('\n') != message.npos || message.find('\r') != message.npos) {
    fail("the error has several lines: " + std::string(message), text);
  }
  if (!message.starts_with("input:")) fail("the error names no line: " + std::string(message), text);
}

// A frame of a scene from the reader is valid, but for what a scene may say and cannot be drawn (points and lines).
void check_frame(const corpus::Scene& scene, std::string_view text) {
  constexpr int kLargestDrawn = 64;  // pixels each way: larger buffers are slow, and say no more
  if (scene.width > kLargestDrawn || scene.height > kLargestDrawn) return;
  const corpus::Frame frame(scene);
  const Status status = validate(frame.target(), frame.draws());
  if (status != Status::ok) fail(std::string("a scene that was read is no valid frame: ") + status_text(status), text);
}

void check(std::string_view text) {
  corpus::Scene scene;
  try {
    scene = corpus::read_scene(text, "input");
  } catch (const corpus::SceneError& error) {
    check_message(error, text);
    return;
  }
  const std::string written = corpus::write_scene(scene);
  corpus::Scene again;
  try {
    again = corpus::read_scene(written, "input");
  } catch (const corpus::SceneError& error) {
    fail(std::string("what was written is refused: ") + error.what(), text);
  }
  if (!corpus::equal(scene, again)) fail("the scene that was written and read again is another one", text);
  if (corpus::write_scene(again) != written) fail("the second writing differs from the first", text);
  check_frame(scene, text);
}

}  // namespace
}  // namespace surefill::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  surefill::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
