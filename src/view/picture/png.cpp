#include <png.h>

#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/view.hpp"

namespace cloud2csg {
namespace {

[[noreturn]] void fail(const std::string& reason) {
  throw Error({.expected = "the picture cannot be compressed: " + reason});
}

}  // namespace

std::string to_png(const Image& image) {
  if (image.width <= 0 || image.height <= 0) fail("it has no pixels");
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&header, nullptr, &size, 0, image.rgb.data(), 0, nullptr) == 0) fail(header.message);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    fail(header.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace cloud2csg
