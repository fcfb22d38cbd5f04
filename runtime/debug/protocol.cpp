#include "runtime/debug/protocol.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace lineshaft::debug {

Json capabilities() {
    return {{"supportsConfigurationDoneRequest", true},
            {"supportsStepBack", true},
            {"supportsTerminateRequest", true},
            {"supportsConditionalBreakpoints", true},
            {"supportsHitConditionalBreakpoints", true},
            {"supportsLogPoints", true},
            {"supportsFunctionBreakpoints", true},
            {"supportsDataBreakpoints", true},
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

Json data_as_json(const std::string& variable, const std::string& name, const std::string& id) {
    if (!id.empty())
        return {{"dataId", id},
                {"description", name.empty() ? variable : name},
                {"accessTypes", {"write"}}};
    const std::string why = fmt::format("'{}' has no place that lasts from scan to scan", variable);
    return {{"dataId", nullptr}, {"description", why}};
}

Json set_data_breakpoints(const Json& arguments, DataBreakpoints& data) {
    std::vector<std::string> ids;
    std::vector<std::string> errors;
    for (const Json& each : list_in(arguments, "breakpoints")) {
        const std::string access = text_in(each, "accessType");
        const bool has_more = !(text_in(each, "condition") + text_in(each, "hitCondition")).empty();
        errors.push_back(!access.empty() && access != "write"
                             ? "it stops where the value changes, which is 'write'"
                         : has_more ? "it stops at each change, and counts nothing"
                                    : "");
        ids.push_back(errors.back().empty() ? text_in(each, "dataId") : "");
    }
    Json all = Json::array();
    for (const DataBreakpoints::Placed& placed : data.set(ids)) {
        const std::string& error = errors[all.size()].empty() ? placed.error : errors[all.size()];
        all.push_back({{"verified", error.empty()}});
        if (error.empty())
            all.back()["id"] = placed.number;
        else
            all.back()["message"] = error;
    }
    return {{"breakpoints", all}};
}

}  // namespace lineshaft::debug
