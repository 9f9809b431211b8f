#!/usr/bin/env python3
"""standard_headers.py ROOT: whether sources have what they use of the standard library from their own includes, or from those of
our headers there, and our constants likewise. With ACDF_BUILD_ONCE several sources are one unit, where the includes of one serve
the next: they would not compile alone. Fails with the lines that lack a header."""
import pathlib
import re
import sys

# Names that one header declares, or a few; those that nearly any header brings along (size_t, move, swap) are left out.
HEADERS = {
    "algorithm": "sort stable_sort partial_sort nth_element lower_bound upper_bound equal_range binary_search min max minmax clamp "
                 "min_element max_element minmax_element fill fill_n copy copy_n copy_if transform generate find find_if all_of "
                 "any_of none_of count count_if equal mismatch reverse rotate unique remove_if replace shuffle is_sorted "
                 "adjacent_find for_each merge partition stable_partition includes lexicographical_compare push_heap pop_heap "
                 "make_heap swap_ranges",
    "array": "array", "atomic": "atomic atomic_flag memory_order_relaxed", "cctype": "isdigit isspace isalpha isalnum tolower",
    "charconv": "to_chars from_chars", "chrono": "chrono", "climits": "", "cmath": "sqrt exp exp2 log log2 log10 pow sin cos tan "
    "asin acos atan atan2 floor ceil round lround llround trunc hypot cbrt erf isfinite isnan isinf signbit copysign ldexp frexp "
    "fmod nextafter nextafterf nexttoward fma expm1 log1p lgamma sinh cosh tanh nan nanf",
    "condition_variable": "condition_variable", "cstdio": "printf fprintf snprintf fopen fclose fread fwrite fputs puts FILE fflush "
    "rename", "cstring": "memcpy memset memcmp memmove strlen strcmp strncmp strstr strchr strerror",
    "deque": "deque", "filesystem": "filesystem", "fstream": "ifstream ofstream fstream", "functional": "function hash ref "
    "greater less plus multiplies reference_wrapper", "future": "async future promise", "initializer_list": "initializer_list",
    "iomanip": "setprecision setw setfill", "iostream": "cout cerr cin clog", "istream": "istream", "iterator": "back_inserter "
    "istreambuf_iterator istream_iterator ostream_iterator distance next prev", "limits": "numeric_limits", "list": "list",
    "map": "map multimap", "memory": "unique_ptr shared_ptr make_unique make_shared weak_ptr", "mutex": "mutex lock_guard "
    "unique_lock scoped_lock once_flag call_once", "numeric": "accumulate iota partial_sum inner_product gcd reduce",
    "optional": "optional nullopt make_optional", "ostream": "ostream", "queue": "queue priority_queue", "random": "mt19937 "
    "mt19937_64 uniform_real_distribution uniform_int_distribution normal_distribution random_device seed_seq", "set": "set multiset",
    "sstream": "stringstream istringstream ostringstream", "stdexcept": "runtime_error logic_error invalid_argument out_of_range "
    "length_error domain_error overflow_error range_error", "string": "string to_string stoul stoull stod stoi getline u8string",
    "string_view": "string_view", "system_error": "error_code system_error errc", "thread": "thread this_thread",
    "tuple": "tuple tie make_tuple", "type_traits": "is_same_v enable_if_t conditional_t decay_t is_floating_point_v is_integral_v "
    "underlying_type_t remove_reference_t is_trivially_copyable_v", "typeinfo": "type_info", "unordered_map": "unordered_map",
    "unordered_set": "unordered_set", "utility": "exchange as_const", "variant": "variant visit get_if "
    "holds_alternative monostate", "vector": "vector", "exception": "exception exception_ptr current_exception rethrow_exception",
}
# What a standard header surely brings along.
WITH = {"charconv": {"system_error"}, "iostream": {"istream", "ostream", "string"}, "sstream": {"string", "istream", "ostream", "iterator"}, "fstream": {"istream", "ostream",
        "string", "iterator"}, "string": {"initializer_list", "string_view"}, "stdexcept": {"string", "exception"}, "map": {"utility"},
        "unordered_map": {"utility"}, "filesystem": {"string", "system_error"}, "istream": {"string", "iterator"}, "ostream": {"string"},
        "vector": {"initializer_list"}, "system_error": {"string"}, "iomanip": {"istream", "ostream"}, "regex": {"string", "vector"},
        "iterator": {"initializer_list"}, "future": {"mutex", "thread", "chrono"}, "thread": {"chrono"}, "condition_variable": {"mutex"},
        "gtest/gtest.h": {"string", "vector", "memory", "ostream", "iostream", "sstream", "tuple", "type_traits", "map", "set",
                          "functional", "limits", "utility", "atomic", "mutex", "cstring", "cstdio"}}
OF = {name: header for header, names in HEADERS.items() for name in names.split()}
ROOTS = ("", "lib", "lib/reader", "lib/arrays", "lib/batch", "lib/curves", "lib/indexed", "lib/visibility", "lib/product", "lib/shader",
         "format", "tools")


def code(text):
    """Without comments and strings."""
    return re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", lambda m: "\n" * m.group(0).count("\n"), text, flags=re.S)


CONSTANT = re.compile(r"\b(?<!benchmark::)(k[A-Z]\w*)\b")
DEFINED = re.compile(r"\bconst(?:expr)?\b[^;(){}=]*?\b(k[A-Z]\w*)\b|[,{]\s*(k[A-Z]\w*)\b(?=\s*(?:\[\w*\]\s*)?[=,}])")


def found(root, path, cache):
    """The standard headers that a file has by itself and by headers of ours, and the constants of these."""
    if path in cache:
        return cache[path]
    cache[path] = set()  # for circles
    out = set()
    for name in re.findall(r"^\s*#\s*include\s*[<\"]([^>\"]+)[>\"]", path.read_text(errors="replace"), re.M):
        ours = next((at for at in (root / r / name for r in ROOTS) if at.is_file()), None)
        beside = path.parent / name
        if ours or beside.is_file():
            out |= found(root, ours or beside, cache)
        else:
            out |= {name} | WITH.get(name, set())
    out |= {first or second for first, second in DEFINED.findall(code(path.read_text(errors="replace")))}
    cache[path] = out
    return out


def lacking(text, headers):
    """(line, name, header) of what is used and not there."""
    for number, line in enumerate(code(text).splitlines(), 1):
        for name in re.findall(r"\bstd::(\w+)", line):
            header = OF.get(name)
            if header and header not in headers:
                yield number, "std::" + name, f"<{header}>"
        for name in CONSTANT.findall(line):
            if name not in headers:
                yield number, name, "the header that defines it"


def main(root):
    assert list(lacking('a;\nstd::sort(x); // std::map\nstd::string s = "std::array";', {"string"})) == [(2, "std::sort", "<algorithm>")]
    root, count, cache = pathlib.Path(root), 0, {}
    for room in ("lib", "tools", "tests", "docs"):
        for path in sorted((root / room).rglob("*.cpp")):
            for line, name, header in lacking(path.read_text(), found(root, path, cache)):
                print(f"{path.relative_to(root)}:{line}: {name} without {header}")
                count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
