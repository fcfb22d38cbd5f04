/// Any text as a quantity and as a unit: what is understood can be written and read back.

#include <cmath>
#include <cstdlib>
#include <string>

#include "runtime/source/units.hpp"

using namespace lineshaft;

namespace {

void require(bool holds) {
    if (!holds) std::abort();
}

void check_quantity(const Quantity& quantity) {
    require(std::isfinite(quantity.number));
    if (const auto time = to_nanoseconds(quantity))
        require(std::abs(static_cast<double>(*time)) <= 9.3e18);
    if (quantity.has_unit) require(Unit::parse(quantity.unit.text).has_value());
    const std::string text = format_number(quantity.number);
    const auto again = parse_quantity(text);
    require(std::holds_alternative<Quantity>(again));
    require(std::get<Quantity>(again).number == quantity.number);
    require(convert(quantity.number, quantity.unit, quantity.unit) == quantity.number);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    if (const auto unit = Unit::parse(text)) {
        require(unit->numerator > 0 && unit->denominator > 0);
        require(Unit::parse(unit->text).has_value());
        require(!unit->dimension_name().empty());
    }
    const auto result = parse_quantity(text);
    if (const auto* quantity = std::get_if<Quantity>(&result)) check_quantity(*quantity);
    return 0;
}
