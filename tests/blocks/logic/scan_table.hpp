#pragma once

#include <initializer_list>
#include <string_view>

namespace lineshaft::test {

/// A timing diagram as text, one row a scan:
///
///     time    in  pt   | q  et
///     0ms     1   5ms  | 0  0ms
///     2400h+3ms  .  .  | 1  5ms
///
/// The first row names the inputs and, behind the bar, the outputs of the block; `time` may be left
/// out. A dot leaves an input as it is. Booleans are 0 and 1.
struct ScanTable {
    std::string_view name;
    std::string_view rows;
};

enum class Calls { once, once_and_twice };

/// Runs a fresh block of `type` through each table and checks its outputs after each scan. With
/// `once_and_twice` each table is run again with every scan called twice: nothing may change.
/// Parameters are named in front of the inputs, as `data_type`, and take their enumeration's names.
void check_tables(std::string_view type, Calls calls, std::initializer_list<ScanTable> tables);

}  // namespace lineshaft::test
