#pragma once

#include <span>
#include <string_view>

namespace lineshaft::st {

/// What the reference says of a function that is no row: Structured Text of the prelude, or what
/// the checker puts something else for. In its signature `=>` is an output; what names no type may
/// be of any that the text names.
struct DescribedFunction {
    std::string_view signature, doc;

    constexpr std::string_view name() const { return signature.substr(0, signature.find('(')); }
};

struct DescribedSubject {
    std::string_view name;
    std::span<const DescribedFunction> functions;
};

std::span<const DescribedSubject> described_functions();

}  // namespace lineshaft::st
