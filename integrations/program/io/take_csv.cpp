// SPDX-License-Identifier: MIT
// CSV: a header `time,NAME,NAME,...`, a row per frame; or what the Live Link Face app writes.
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr const char* kCannotReadTable = "cannot read take";
constexpr double kTimecodeRate = 60;
constexpr double kDay = 24 * 3600;

/// Fields of one row after the other; quotes keep commas and line ends in a field.
class CsvReader {
 public:
  explicit CsvReader(std::string_view text) : text_(text) {}

  size_t line() const { return line_; }              // of the row that was read last, from 1
  size_t open_quote() const { return open_quote_; }  // line of one that is not closed, or 0

  /// False at the end. Rows without anything are left out.
  bool next(std::vector<std::string>& fields) {
    do {
      if (at_ >= text_.size()) return false;
      line_ = next_line_;
      read_row(fields);
    } while (fields.size() == 1 && fields[0].empty());
    return true;
  }

 private:
  void read_row(std::vector<std::string>& fields) {
    fields.clear();
    for (bool more = true; more;) {
      fields.emplace_back();
      more = read_field(fields.back());
    }
  }

  /// Whether another one follows in the row.
  bool read_field(std::string& field) {
    bool quoted = false, was_quoted = false;
    size_t quote_line = 0;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      const bool ends_row = c == '\n' || (!quoted && is_return_alone());
      if (ends_row) ++next_line_;
      if (quoted && c == '"' && at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        field += text_[++at_];
      } else if (c == '"' && (quoted || field.empty())) {
        quoted = !quoted;
        was_quoted = true;
        quote_line = next_line_;
      } else if (quoted) {
        field += c;
      } else if (c == ',' || ends_row) {
        ++at_;
        trim(field, was_quoted);
        return c == ',';
      } else {
        field += c;
      }
    }
    if (quoted) open_quote_ = quote_line;
    trim(field, was_quoted);
    return false;
  }

  /// As old programs end lines.
  bool is_return_alone() const {
    return text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] != '\n';
  }

  static void trim(std::string& field, bool was_quoted) {
    if (!field.empty() && field.back() == '\r') field.pop_back();
    if (was_quoted) return;
    const size_t first = field.find_first_not_of(" \t"), last = field.find_last_not_of(" \t");
    field = first == std::string::npos ? "" : field.substr(first, last - first + 1);
  }

  std::string_view text_;
  size_t at_ = 0, line_ = 0, next_line_ = 1, open_quote_ = 0;
};

bool is_word(const std::string& text, std::string_view lower) {
  if (text.size() != lower.size()) return false;
  for (size_t i = 0; i < lower.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(text[i])) != lower[i]) return false;
  }
  return true;
}

struct Table {
  Take take;
  std::vector<std::string> header;
  size_t first_value = 1;  // column
  bool gaps = false;       // empty cells are NaN

  [[noreturn]] void fail_cell(size_t line, size_t column, const std::string& why,
                              const std::string& what_to_do) const {
    fail(kInvalid, kCannotReadTable,
         take.shown + ", row " + std::to_string(line) + ", column " + std::to_string(column + 1) +
             " (" + one_line(header[column]) + ")",
         why, what_to_do);
  }
};

/// The nearest float; numbers too small for one are zero.
float parse_value(const Table& table, size_t line, size_t column, const std::string& field) {
  if (field.empty() && table.gaps) return NAN;
  if (field.empty()) table.fail_cell(line, column, "the cell is empty", "write a number");
  const char *begin = field.data(), *end = begin + field.size();
  if (*begin == '+') ++begin;
  float value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (stop != end || error == std::errc::invalid_argument) {
    table.fail_cell(line, column, "\"" + one_line(field) + "\" is not a number", "write a number");
  }
  if (error == std::errc::result_out_of_range) value = std::strtof(begin, nullptr);
  if (!std::isfinite(value)) {
    table.fail_cell(line, column, one_line(field) + " is not a finite 32-bit float",
                    "controls are usually in 0..1");
  }
  return value;
}

double parse_time(Table& table, size_t line, const std::string& field) {
  double time = 0;
  const char *begin = field.data(), *end = begin + field.size();
  const auto [stop, error] = std::from_chars(begin, end, time);
  if (error != std::errc() || stop != end || !std::isfinite(time)) {
    table.fail_cell(line, 0, "\"" + one_line(field) + "\" is not a time", "give seconds");
  }
  const size_t point = field.find('.');
  const size_t exponent = field.find_first_of("eE");
  if (exponent == std::string::npos) {
    const size_t decimals = point == std::string::npos ? 0 : field.size() - point - 1;
    const double half_unit = 0.5 * std::pow(10.0, -static_cast<double>(decimals));
    // Zeros at the end are often left out: the longest number tells.
    if (table.take.times.seconds.empty() || half_unit < table.take.times.precision) {
      table.take.times.precision = half_unit;
    }
  } else {
    table.take.times.precision = 0;
  }
  return time;
}

/// `HH:MM:SS:FF.sss`, 60 frames a second.
double parse_timecode(const Table& table, size_t line, const std::string& field) {
  double parts[4] = {};
  const char *at = field.data(), *end = at + field.size();
  for (size_t i = 0; i < 4; ++i) {
    const auto [stop, error] = std::from_chars(at, end, parts[i], std::chars_format::fixed);
    const bool ends = i == 3 ? stop == end : stop != end && (*stop == ':' || *stop == ';');
    if (error != std::errc() || !ends || parts[i] < 0) {
      table.fail_cell(line, 0, "\"" + one_line(field) + "\" is not a timecode",
                      "timecodes are HH:MM:SS:FF.sss");
    }
    at = stop + 1;
  }
  if (parts[0] >= 24 || parts[1] >= 60 || parts[2] >= 60 || parts[3] >= kTimecodeRate) {
    table.fail_cell(line, 0, "\"" + one_line(field) + "\" is not a time of a day",
                    "timecodes are HH:MM:SS:FF.sss, at 60 frames a second");
  }
  return (parts[0] * 60 + parts[1]) * 60 + parts[2] + parts[3] / kTimecodeRate;
}

void add_time(Table& table, size_t line, const std::string& field) {
  std::vector<double>& seconds = table.take.times.seconds;
  double time =
      table.take.is_live_link ? parse_timecode(table, line, field) : parse_time(table, line, field);
  if (table.take.is_live_link && !seconds.empty()) {
    // Past midnight.
    while (time < seconds.back() - kDay / 2) time += kDay;
  }
  if (!seconds.empty() && time <= seconds.back()) {
    table.fail_cell(line, 0, "\"" + one_line(field) + "\" is not later than the row before",
                    "sort the rows by time, and leave out duplicates");
  }
  seconds.push_back(time);
}

void read_header(Table& table) {
  std::vector<std::string>& header = table.header;
  const std::string where = table.take.shown + ", row 1";
  const bool live_link =
      header.size() > 2 && is_word(header[0], "timecode") && is_word(header[1], "blendshapecount");
  if (!live_link && !is_word(header[0], "time")) {
    const std::string first = "\"" + one_line(header[0].substr(0, 40)) + "\"";
    if (header.size() == 1 && header[0].find_first_of(";\t") != std::string::npos) {
      fail(kInvalid, kCannotReadTable, where, first + " is one column",
           "put commas between the columns");
    }
    const std::string& start = header[0];
    if (start.compare(0, 2, "\xff\xfe") == 0 || start.compare(0, 2, "\xfe\xff") == 0) {
      fail(kInvalid, kCannotReadTable, table.take.shown, "it is UTF-16 text", "save it as UTF-8");
    }
    if (header.size() > 1) {
      fail(kInvalid, kCannotReadTable, where, "the first column is " + first + ", not \"time\"",
           "put the time of each row there, in seconds, and name it time");
    }
    fail(kInvalid, kCannotReadTable, where,
         "it begins with " + first + ": this is neither JSON nor a table of controls",
         "give a CSV with the header time,NAME,NAME,... or see 'mien help clip build'");
  }
  table.take.is_live_link = live_link;
  table.first_value = live_link ? 2 : 1;
  std::unordered_map<std::string, size_t> columns;
  for (size_t c = table.first_value; c < header.size(); ++c) {
    if (header[c].empty()) {
      fail(kInvalid, kCannotReadTable, where + ", column " + std::to_string(c + 1),
           "it has no name", "name it, or remove a comma at the end of the row");
    }
    const auto [first, is_new] = columns.try_emplace(header[c], c);
    if (!is_new) {
      fail(kInvalid, kCannotReadTable, where + ", column " + std::to_string(c + 1),
           "\"" + one_line(header[c]) + "\" is also column " + std::to_string(first->second + 1),
           "leave one of them out");
    }
    table.take.names.push_back(header[c]);
  }
}

}  // namespace

Take parse_csv_take(std::string_view text, const std::string& shown, bool gaps) {
  Table table;
  table.gaps = gaps;
  Take& take = table.take;
  take.shown = shown;
  CsvReader reader(text);
  if (!reader.next(table.header)) {
    fail(kInvalid, kCannotReadTable, shown, "it is empty",
         "give a CSV with the header time,NAME,NAME,... or frames as JSON");
  }
  read_header(table);
  std::vector<std::string> fields;
  while (reader.open_quote() == 0 && reader.next(fields)) {
    const size_t line = reader.line();
    if (reader.open_quote() != 0) break;
    if (fields.size() != table.header.size()) {
      fail(kInvalid, kCannotReadTable, shown + ", row " + std::to_string(line),
           "it has " + std::to_string(fields.size()) +
               (fields.size() == 1 ? " column" : " columns") + ", the header has " +
               std::to_string(table.header.size()),
           "give all rows the same number of columns");
    }
    add_time(table, line, fields[0]);
    for (size_t c = table.first_value; c < fields.size(); ++c) {
      take.values.push_back(parse_value(table, line, c, fields[c]));
    }
    take.lines.push_back(line);
    ++take.row_count;
  }
  if (reader.open_quote() != 0) {
    fail(kInvalid, kCannotReadTable, shown + ", row " + std::to_string(reader.open_quote()),
         "a quotation mark opens there and none closes it", "close it, or leave it out");
  }
  if (take.row_count == 0) {
    fail(kInvalid, kCannotReadTable, shown, "there are no rows below the header",
         "add a row per frame");
  }
  return std::move(table.take);
}

}  // namespace mien::cli
