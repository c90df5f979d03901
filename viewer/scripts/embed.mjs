// Writes a file as C++: the definition of page_template(). String literals, since compilers are slow with long lists of
// numbers.
import { readFileSync, writeFileSync } from "node:fs";

const [page, output] = process.argv.slice(2);
if (!page || !output) throw new Error("usage: embed.mjs PAGE OUTPUT.cpp");

const bytes = readFileSync(page);
const k_line = 100;

// Octal with three digits always: what follows is never taken for a part of it. A question mark could begin a trigraph.
const literal = (byte) =>
  byte < 32 || byte > 126 || byte === 34 || byte === 92 || byte === 63
    ? `\\${byte.toString(8).padStart(3, "0")}`
    : String.fromCharCode(byte);

const lines = [];
for (let i = 0; i < bytes.length; i += k_line) {
  lines.push(`    "${[...bytes.subarray(i, i + k_line)].map(literal).join("")}"`);
}
writeFileSync(
  output,
  `#include "view/report/page_template.hpp"

namespace {
constexpr char k_page[] =
${lines.join("\n")};
}  // namespace

std::string_view cloud2csg::page_template() {
  return {k_page, sizeof k_page - 1};
}
`,
);
