#pragma once

#include <string>

#include "core/base/random.hpp"

namespace cloud2csg::fuzz {

/// The bytes with one to three changes, such as damage and ill will make them: bytes turned, cut off, put in, left out,
/// said twice or many times; numbers, in text or in 32 bits, replaced by those that programs get wrong.
[[nodiscard]] std::string mutated(std::string bytes, RandomStream& random);

}  // namespace cloud2csg::fuzz
