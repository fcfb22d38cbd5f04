#include "runtime/source/json_text.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace lineshaft {

using Json = nlohmann::ordered_json;

namespace {

/// Keys are put behind each other without a look at those before: the library's own builder
/// compares each with all of them, and with a callback each object with all that stand beside it.
class JsonBuilder final : public nlohmann::json_sax<Json> {
  public:
    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t&) override { return false; }
    bool key(string_t& value) override {
        key_ = std::move(value);
        return true;
    }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
        return false;
    }

    Json root;

  private:
    bool add(Json value) { return place(std::move(value)) != nullptr; }
    bool open(Json value) {
        if (open_.size() >= deepest_json) return false;
        open_.push_back(place(std::move(value)));
        return open_.back() != nullptr;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    /// Where it stands now; null when there are too many.
    Json* place(Json value) {
        if (++count_ > most_json_values) return nullptr;
        if (open_.empty()) {
            root = std::move(value);
            return &root;
        }
        if (auto* const items = open_.back()->get_ptr<Json::array_t*>())
            return &items->emplace_back(std::move(value));
        auto& entries = open_.back()->get_ref<Json::object_t&>();
        return &entries.emplace_back(std::move(key_), std::move(value)).second;
    }

    std::vector<Json*> open_;
    std::string key_;
    std::size_t count_ = 0;
};

}  // namespace

Json parse_json(std::string_view text) {
    JsonBuilder builder;
    return Json::sax_parse(text, &builder) ? std::move(builder.root) : Json();
}

std::optional<std::int64_t> integer_at(const Json& object, const char* key, std::int64_t least,
                                       std::int64_t most) {
    if (!object.is_object()) return {};
    const auto it = object.find(key);
    if (it == object.end() || !it->is_number_integer()) return {};
    if (it->is_number_unsigned() &&
        it->get<std::uint64_t>() > static_cast<std::uint64_t>(std::max(most, std::int64_t{0})))
        return {};
    const auto value = it->get<std::int64_t>();
    return value >= least && value <= most ? std::optional(value) : std::nullopt;
}

std::string text_at(const Json& object, const char* key) {
    if (!object.is_object()) return {};
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : std::string();
}

}  // namespace lineshaft
