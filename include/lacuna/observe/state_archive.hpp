// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <cereal/cereal.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>

#include <lacuna/core/aggregate.hpp>
#include <lacuna/core/state.hpp>

/// \file
/// Archives of cereal for states: plain bytes in memory. The reader trusts no input: it never reads beyond its bytes,
/// makes no array longer than they can fill, and refuses bad bytes with std::runtime_error.

namespace lacuna {

/// Writes a state as bytes, in the byte order of the machine.
class state_writer : public cereal::OutputArchive<state_writer, cereal::AllowEmptyClassElision> {
public:
    state_writer() : cereal::OutputArchive<state_writer, cereal::AllowEmptyClassElision>(this) {}
    void saveBinary(void const* data, std::size_t size) {
        if (size > 0) bytes_.append(static_cast<char const*>(data), size);
    }
    std::string const& bytes() const noexcept { return bytes_; }

private:
    std::string bytes_;
};

/// Reads the bytes of a state. \throws std::runtime_error for bytes that are not such a state
class state_reader : public cereal::InputArchive<state_reader, cereal::AllowEmptyClassElision> {
public:
    explicit state_reader(std::string_view bytes)
        : cereal::InputArchive<state_reader, cereal::AllowEmptyClassElision>(this), bytes_(bytes) {}
    void loadBinary(void* data, std::size_t size) {
        require_state(size <= bytes_.size(), "it ends too early");
        if (size > 0) std::memcpy(data, bytes_.data(), size);
        bytes_.remove_prefix(size);
    }
    /// Reads the length of a list. Refuses one that exceeds the remaining bytes, before any memory is allocated.
    void load_length(std::uint64_t& length) {
        loadBinary(&length, sizeof length);
        require_state(length <= bytes_.size(), "a list is longer than the file");
    }
    std::size_t left() const noexcept { return bytes_.size(); }

private:
    std::string_view bytes_;
};

template <class Archive>
concept state_archive = std::is_same_v<Archive, state_writer> || std::is_same_v<Archive, state_reader>;

namespace detail {
template <class T>
inline constexpr bool is_std_array = false;
template <class T, std::size_t N>
inline constexpr bool is_std_array<std::array<T, N>> = true;
template <class T>
inline constexpr bool is_fixed_length = false;
template <class Array>
inline constexpr bool is_fixed_length<fixed_length<Array>> = true;

/// An aggregate without `serialize`, which is archived member by member.
template <class T, class Archive>
concept plain_aggregate = std::is_aggregate_v<T> && !std::is_array_v<T> && !is_std_array<T> && !is_fixed_length<T> &&
                          !requires(T& value, Archive& ar) { value.serialize(ar); };
} // namespace detail

/// \name How cereal archives each kind of value
/// \{
template <class T>
    requires std::is_arithmetic_v<T>
void CEREAL_SAVE_FUNCTION_NAME(state_writer& ar, T const& value) {
    ar.saveBinary(&value, sizeof value);
}
template <class T>
    requires std::is_arithmetic_v<T>
void CEREAL_LOAD_FUNCTION_NAME(state_reader& ar, T& value) {
    if constexpr (std::is_same_v<T, bool>) {
        std::uint8_t byte = 0;
        ar.loadBinary(&byte, 1);
        require_state(byte <= 1, "a truth value that is neither 0 nor 1");
        value = byte == 1;
    } else {
        ar.loadBinary(&value, sizeof value);
    }
}
template <class T>
void CEREAL_SAVE_FUNCTION_NAME(state_writer& ar, cereal::BinaryData<T> const& data) {
    ar.saveBinary(data.data, std::size_t(data.size));
}
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(state_reader& ar, cereal::BinaryData<T>& data) {
    ar.loadBinary(data.data, std::size_t(data.size));
}
template <class T>
void CEREAL_SAVE_FUNCTION_NAME(state_writer& ar, cereal::SizeTag<T> const& tag) {
    std::uint64_t const length = tag.size;
    ar.saveBinary(&length, sizeof length);
}
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(state_reader& ar, cereal::SizeTag<T>& tag) {
    std::uint64_t length = 0;
    ar.load_length(length);
    tag.size = length;
}
template <state_archive Archive, class T>
void CEREAL_SERIALIZE_FUNCTION_NAME(Archive& ar, cereal::NameValuePair<T>& named) {
    ar(named.value);
}
template <class Array>
void CEREAL_SAVE_FUNCTION_NAME(state_writer& ar, fixed_length<Array> const& fixed) {
    ar(fixed.array);
}
template <class Array>
void CEREAL_LOAD_FUNCTION_NAME(state_reader& ar, fixed_length<Array>& fixed) {
    std::size_t const expected = fixed.array.size();
    ar(fixed.array);
    require_state(fixed.array.size() == expected, "a list has another length than expected");
}
template <state_archive Archive, detail::plain_aggregate<Archive> T>
void CEREAL_SERIALIZE_FUNCTION_NAME(Archive& ar, T& value) {
    for_each_member(value, [&](auto& member) { ar(member); });
}
/// \}

} // namespace lacuna

CEREAL_SETUP_ARCHIVE_TRAITS(lacuna::state_reader, lacuna::state_writer)
