#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// Memory as it begins: from slot `at` of an image on what a variable, a type or a constant says.
void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Variable& variable);
void fill(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type,
          const Expression& value);
void fill_default(Writing& w, Writing::Image& image, std::uint32_t at, const Type& type);

/// What stands behind BEGIN are initial values.
void fill_data_block(Writing& w, Writing::Image& image, const Global& global);

/// All images that instructions use go into the code, once each.
void finish_images(Writing& w);

}  // namespace lineshaft::st
