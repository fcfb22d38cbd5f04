#pragma once

#include <string>
#include <vector>

namespace lineshaft {

using Cells = std::vector<std::string>;

/// Rows as lines of aligned columns, two blanks between; a column without any text is left out.
std::string align(const std::vector<Cells>& rows);

/// Enough digits to compare by eye: four, of whole numbers all; in percent on request.
std::string short_number(double value, bool percent = false);

/// Decimals of a percentage: one, and for small ones two digits.
int decimals(double percentage);

}  // namespace lineshaft
