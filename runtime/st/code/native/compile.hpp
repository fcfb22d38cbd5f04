#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "runtime/st/code/native/native.hpp"

/// `--native`: what a compiler makes of the code, in place of what is copied.
namespace lineshaft::st {

/// From now on `native_code` asks for it, too; no more with null. `tell` is called at most once,
/// from any thread, with why there will be none.
void compile_natively(void (*tell)(const std::string& why));

/// What the system's compiler makes of the code becomes that of `native`: at once, where it is in
/// the cache; else when the compiler has made it, of which one runs at a time, beside what goes on.
/// The code that was copied runs until then.
void compile_code(const Code& code, const std::shared_ptr<Native>& native);

/// Waits for the compiler, until `interrupt_requested`, which ends it. Gives how many codes have
/// what it made.
std::size_t end_compiling();

}  // namespace lineshaft::st
