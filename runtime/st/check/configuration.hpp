#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

// What a CONFIGURATION says of the programs that it has (IEC 61131-3:2013, 6.8.2), and VAR_CONFIG,
// which CODESYS has beside all blocks, of a PROGRAM by its name.

/// A program that is connected, or has variables in VAR_CONFIG, becomes a PROGRAM that extends its
/// type, by its path, `R1.P1`. Before names are collected.
void add_configured_programs(Checking& c);

/// What variables in VAR_CONFIG begin with, and what is copied before and behind a scan: inputs,
/// outputs, and variables that stand at an address there. When all variables are declared.
void configure_programs(Checking& c);

/// These copies around the body, which is checked; behind it wherever it is left.
void connect(Checking& c, Routine& routine);

}  // namespace lineshaft::st
