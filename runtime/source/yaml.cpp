#include "runtime/source/yaml.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <filesystem>
#include <new>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/encoding.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/yaml_builder.hpp"
#include "runtime/source/yaml_mistakes.hpp"

namespace lineshaft {

namespace {

void build(const YamlText& source, YamlBuilder& builder, Diagnostics& out) {
    try {
        std::istringstream in{std::string(source.text())};
        YAML::Parser parser(in);
        if (!parser.HandleNextDocument(builder)) {
            out.add(code::root_is_no_map, source.mark(0), "the file is empty");
            return;
        }
        parser.HandleNextDocument(builder);
    } catch (const YamlStop&) {
        builder.check_open_maps();
    } catch (const YAML::Exception& fault) {
        builder.check_open_maps();
        report_mistake(fault, source, builder, out);
    } catch (const std::bad_alloc&) {
        throw;  // of memory, not of the file
    } catch (const std::exception& fault) {
        out.add(code::not_yaml, source.mark(0),
                fmt::format("the file cannot be read as YAML: {}", fault.what()));
    }
}

/// What another tool's project is kept in; empty: neither.
std::string_view foreign_form(std::string_view text) {
    if (text.starts_with("PK\x03\x04")) return "an archive";
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), text.size()));
    return text.starts_with('<') && !text.starts_with("<<") ? "XML" : "";
}

/// `line.yaml` of `line` or `line.yml`, where that is there.
std::string file_meant(const std::string& path) {
    std::error_code unknown;
    std::filesystem::path other = path;
    other.replace_extension(".yaml");
    const bool is_name = path.find('\0') == path.npos;
    if (!is_name || other == path || !std::filesystem::is_regular_file(other, unknown)) return {};
    return fmt::format("did you mean '{}'?", other.string());
}

std::string reason_of(int error) {
    if (error == ENOENT) return "it does not exist";
    if (error == EISDIR) return "it is a directory";
    if (error == EACCES) return "you have no permission";
    return std::generic_category().message(error);
}

}  // namespace

Node::Node() = default;
Node::Node(const Node&) = default;
Node::Node(Node&&) noexcept = default;
Node& Node::operator=(const Node&) = default;
Node& Node::operator=(Node&&) noexcept = default;
Node::~Node() = default;

const Node* Node::find(std::string_view key) const {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const auto& entry) { return entry.first.text == key; });
    return found == entries.end() ? nullptr : &found->second;
}

Node node_of(std::string text) {
    Node node;
    node.text = std::move(text);
    return node;
}

std::vector<std::string> Node::keys() const {
    std::vector<std::string> names;
    names.reserve(entries.size());
    for (const auto& [key, value] : entries) names.push_back(key.text);
    return names;
}

std::optional<Node> parse_yaml(std::shared_ptr<const SourceFile> file, Diagnostics& out,
                               const YamlLimits& limits) {
    assert(file);
    if (file->text.size() > limits.bytes) {
        out.add(code::file_too_large, {file, 1, 1, 1},
                fmt::format("the file has more than {} bytes", limits.bytes));
        return {};
    }
    if (const std::string_view form = foreign_form(file->text); !form.empty()) {
        out.add(code::root_is_no_map, {file, 1, 1, 1},
                fmt::format("this is {}, and no program of lineshaft", form),
                "have the tool that made it export PLCopen XML (TC6), or give its Structured Text");
        return {};
    }
    const std::size_t before = out.count();
    const YamlText source(std::move(file));
    check_characters(source, out);
    check_brackets(source, limits, out);
    if (out.count() != before) return {};

    YamlBuilder builder(source, out, limits);
    build(source, builder, out);
    if (out.count() != before) return {};
    return builder.take_root();
}

std::shared_ptr<const SourceFile> read_source(const std::string& path, Diagnostics& out, Mark where,
                                              const YamlLimits& limits) {
    const std::string looked_for =
        where.file ? fmt::format("the path counts from the folder of '{}'", where.file->path)
                   : std::string();
    int error = path.find('\0') == std::string::npos ? 0 : ENOENT;
    std::string text;
    if (error == 0) text = read_bytes(path, limits.bytes + 1, error);
    if (error != 0) {
        out.add(code::file_cannot_be_read, std::move(where),
                fmt::format("cannot read '{}': {}", path, reason_of(error)),
                looked_for.empty() ? file_meant(path) : looked_for);
        return nullptr;
    }
    if (text.size() > limits.bytes) {
        out.add(code::file_too_large, std::move(where),
                fmt::format("'{}' has more than {} bytes", path, limits.bytes));
        return nullptr;
    }
    if (is_structured_text(path)) text = as_utf8(std::move(text));
    return std::make_shared<const SourceFile>(SourceFile{path, std::move(text)});
}

}  // namespace lineshaft
