#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lineshaft {

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Collects what must be kept to go on later, as bytes. Plain data without pointers only; read back
/// by the same version on the same kind of machine.
class StateWriter {
  public:
    template <Plain T>
    void put(const T& value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <Plain T>
    void put(const std::vector<T>& values) {
        put(std::uint64_t{values.size()});
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        bytes_ += text;
    }

    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Reads in the order of the writing. What is not there leaves the target as it was and clears
/// ok().
class StateReader {
  public:
    explicit StateReader(std::string_view bytes) : left_(bytes) {}

    template <Plain T>
    void get(T& value) {
        take(reinterpret_cast<char*>(&value), sizeof value);
    }
    /// `values` has the size that was written, or it is not the same machine.
    template <Plain T>
    void get(std::vector<T>& values) {
        std::uint64_t size = 0;
        get(size);
        ok_ = ok_ && size == values.size();
        take(reinterpret_cast<char*>(values.data()), values.size() * sizeof(T));
    }
    void get(std::string& text) {
        std::uint64_t size = 0;
        get(size);
        ok_ = ok_ && size <= left_.size();
        if (!ok_) return;
        text.resize(size);
        take(text.data(), size);
    }

    bool ok() const { return ok_; }
    bool at_end() const { return ok_ && left_.empty(); }

  private:
    void take(char* target, std::size_t size) {
        ok_ = ok_ && size <= left_.size();
        if (!ok_ || size == 0) return;
        std::memcpy(target, left_.data(), size);
        left_.remove_prefix(size);
    }

    std::string_view left_;
    bool ok_ = true;
};

}  // namespace lineshaft
