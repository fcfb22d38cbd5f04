#pragma once

#include <cstddef>
#include <cstdint>

namespace lineshaft {

/// Room that every function below needs at `to`; each returns the end of what it has written. They
/// write in words: a sign, sixteen digits, the point and sixteen bytes more.
constexpr std::size_t longest_number = 34;

char* write_integer(char* to, std::int64_t value);
char* write_unsigned(char* to, std::uint64_t value);

/// The shortest decimal number that reads back as the same double; with an exponent below 1e-4 and
/// from 1e16 on. What is not finite is NaN, INF or -INF, as CSVW and XML Schema have it.
char* write_real(char* to, double value);

/// Integer nanoseconds as seconds, exact: `-0.00125`.
char* write_seconds(char* to, std::int64_t nanoseconds);

}  // namespace lineshaft
