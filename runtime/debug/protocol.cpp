#include "runtime/debug/protocol.hpp"

#include <filesystem>

namespace lineshaft::debug {

Json capabilities() {
    return {{"supportsConfigurationDoneRequest", true},
            {"supportsStepBack", true},
            {"supportsTerminateRequest", true},
            {"supportsConditionalBreakpoints", true},
            {"supportsHitConditionalBreakpoints", true},
            {"supportsLogPoints", true},
            {"supportsFunctionBreakpoints", true},
            {"supportsEvaluateForHovers", true},
            {"supportsSetVariable", true},
            {"exceptionBreakpointFilters",
             {{{"filter", "block_error"}, {"label", "An error of a block"}, {"default", true}}}},
            {"supportTerminateDebuggee", true}};
}

Json source_of(const std::string& path) {
    std::error_code unknown;
    const auto whole = std::filesystem::absolute(path, unknown);
    return {{"name", std::filesystem::path(path).filename().string()},
            {"path", unknown ? path : whole.lexically_normal().string()}};
}

std::vector<Wanted> wanted_in(const Json& arguments, int shift) {
    std::vector<Wanted> wanted;
    for (const Json& each : list_in(arguments, "breakpoints"))
        wanted.push_back({.line = static_cast<int>(number_in(each, "line")) + shift,
                          .condition = text_in(each, "condition"),
                          .hits = text_in(each, "hitCondition"),
                          .log = text_in(each, "logMessage")});
    return wanted;
}

Json breakpoint_as_json(const Breakpoint& breakpoint, const std::string& path, int shift) {
    Json one{{"id", breakpoint.id},
             {"verified", breakpoint.is_verified},
             {"line", breakpoint.line - shift},
             {"source", source_of(path)}};
    if (!breakpoint.is_verified) one["message"] = breakpoint.error;
    return one;
}

}  // namespace lineshaft::debug
