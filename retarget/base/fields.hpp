// The members of a struct, listed once: equality, keys, JSON and ranges follow from that list. Beside a
// struct:
//   template <class V, class S>
//   FieldsOf<S, Trim> fields(V& visit, S& trim) {
//     visit("first", trim.first, kFrameNumbers);
//     visit("last", trim.last, kFrameNumbers);
//   }
// A visitor is called as visit(name, value, rule...), with at most one rule; name is a const char* or a
// MemberName, value is const where the struct is.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace understudy {

/// void, for S that is T or const T.
template <class S, class T>
using FieldsOf = std::enable_if_t<std::is_same_v<std::remove_const_t<S>, T>>;

/// The name of a member that older files call otherwise.
struct MemberName {
  MemberName(const char* name, const char* old_name = nullptr) : now(name), before(old_name) {}
  operator const char*() const { return now; }
  const char *now, *before;  ///< before: null where it has always had its name
};

/// Members that are compared but never written need no names.
template <class V, class... M>
void unnamed(V& visit, M&... members) {
  (visit("", members), ...);
}

// Rules: what a value must be, beside its type. Floats without a rule are any finite number.

/// A number from low to high; others are refused.
template <class Number>
struct Within {
  Number low, high;
};
/// The same of what is only shown: others are brought into the range.
template <class Number>
struct Clamped {
  Number low = std::numeric_limits<Number>::lowest(), high = std::numeric_limits<Number>::max();
};
/// Numbers of frames.
constexpr Within<int> kFrameNumbers{0, 1000000000};
/// The names of an enum's values, in their order.
template <size_t N>
using Names = std::array<const char*, N>;
/// A text that is the path of a file or folder.
struct FilePath {};

namespace detail {

template <template <class...> class Template, class T>
constexpr bool kIs = false;
template <template <class...> class Template, class... A>
constexpr bool kIs<Template, Template<A...>> = true;

struct AnyVisitor {
  template <class... A>
  void operator()(A&&...) const {}
};
template <class T, class = void>
constexpr bool kHasFields = false;
template <class T>
constexpr bool kHasFields<T, std::void_t<decltype(fields(std::declval<AnyVisitor&>(), std::declval<T&>()))>> =
    true;

template <class T, class = void>
constexpr bool kIsMatrix = false;
template <class T>
constexpr bool kIsMatrix<T, std::void_t<decltype(std::declval<T>().coeff(0, 0))>> = true;

template <class T>
std::shared_ptr<const T> or_default(const std::shared_ptr<T>& pointer) {
  return pointer ? pointer : std::make_shared<T>();
}

}  // namespace detail

/// Whether all that is listed is equal, deeply. A null pointer is like one to a default.
template <class T>
bool same(const T& a, const T& b) {
  if constexpr (detail::kHasFields<const T>) {
    std::vector<const void*> of_b;
    size_t next = 0;
    bool equal = true;
    const auto collect = [&](const char*, const auto& value, const auto&...) { of_b.push_back(&value); };
    const auto compare = [&](const char*, const auto& value, const auto&...) {
      equal = equal && same(value, *static_cast<decltype(&value)>(of_b[next++]));
    };
    fields(collect, b);
    fields(compare, a);
    return equal;
  } else if constexpr (detail::kIsMatrix<T>) {
    return a.rows() == b.rows() && a.cols() == b.cols() && (a.array() == b.array()).all();
  } else if constexpr (detail::kIs<std::optional, T>) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
  } else if constexpr (detail::kIs<std::shared_ptr, T>) {
    return a == b || same(*detail::or_default(a), *detail::or_default(b));
  } else if constexpr (detail::kIs<std::variant, T>) {
    const auto like_b = [&b](const auto& value) {
      const auto* other = std::get_if<std::decay_t<decltype(value)>>(&b);
      return other && same(value, *other);
    };
    return std::visit(like_b, a);
  } else if constexpr (detail::kIs<std::vector, T>) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return same(x, y); });
  } else {
    return a == b;
  }
}

namespace detail {

/// Appends what no other value of the type gives: numbers to the bit, texts and lists behind their size.
template <class T>
void add_key(std::string& text, const T& value) {
  const auto add = [&text](const auto& one) { add_key(text, one); };
  const auto visit = [&text](const char*, const auto& member, const auto&...) { add_key(text, member); };
  if constexpr (kHasFields<const T>) {
    fields(visit, value);
  } else if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>) {
    add(static_cast<int>(value));
  } else if constexpr (std::is_arithmetic_v<T>) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    text += ' ';
  } else if constexpr (kIsMatrix<T>) {
    add(value.rows());
    add(value.cols());
    for (auto i = 0 * value.rows(); i < value.rows(); ++i)
      for (auto j = 0 * value.cols(); j < value.cols(); ++j) add(value.coeff(i, j));
  } else if constexpr (kIs<std::optional, T>) {
    add(value.has_value());
    if (value) add(*value);
  } else if constexpr (kIs<std::shared_ptr, T>) {
    add(*or_default(value));
  } else if constexpr (kIs<std::variant, T>) {
    add(value.index());
    std::visit(add, value);
  } else if constexpr (kIs<std::pair, T>) {
    add(value.first);
    add(value.second);
  } else if constexpr (std::is_same_v<T, std::string>) {
    add(value.size());
    text += value;
  } else {
    add(value.size());
    for (const auto& one : value) add(one);
  }
}

}  // namespace detail

/// A text that two values of these types share only when all that is listed of them is equal.
template <class... T>
std::string key_of(const T&... values) {
  std::string text;
  (detail::add_key(text, values), ...);
  return text;
}

}  // namespace understudy
