#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "bus/config.h"

namespace halocline::bus {
namespace {

// The shortest decimal that reads back as the same double; always with a point or exponent, as TOML wants for
// floats.
std::string exact(double value) {
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    const bool plain = std::strchr(text, 'e') == nullptr || std::abs(value) >= 1e9 || std::abs(value) < 1e-4;
    if (std::strtod(text, nullptr) == value && plain) break;
  }
  const std::string shortest = text;
  return shortest.find_first_of(".einf") == std::string::npos ? shortest + ".0" : shortest;
}

std::string quoted(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\\' || c == '"') text += '\\';
    if (code < 0x20 || code == 0x7f) {  // control characters: TOML takes them by their code alone
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", unsigned{code});
      text += escape;
    } else {
      text += c;
    }
  }
  return text + "\"";
}

class Writer : public ConfigVisitor {
 public:
  Writer(std::ostringstream& out, std::string path, bool with_comments)
      : out_(out), path_(std::move(path)), with_comments_(with_comments) {}

  void number(std::string_view key, double& value, const NumberRule& rule) override {
    line(key, exact(value), described(rule));
  }
  void integer(std::string_view key, std::int64_t& value, const NumberRule& rule) override {
    line(key, std::to_string(value), described(rule));
  }
  void boolean(std::string_view key, bool& value, std::string_view meaning) override {
    line(key, value ? "true" : "false", std::string(meaning));
  }
  void text(std::string_view key, std::string& value, const std::vector<std::string>& allowed,
            std::string_view meaning) override {
    std::string comment(meaning);
    for (std::size_t i = 0; i < allowed.size(); ++i) comment += (i == 0 ? ": " : ", ") + allowed[i];
    line(key, quoted(value), comment);
  }
  void vector3(std::string_view key, Vec3& value, const NumberRule& rule) override {
    line(key, array(value), described(rule));
  }
  void numbers(std::string_view key, std::vector<double>& values, const NumberRule& rule) override {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : ", ") + exact(value);
    line(key, "[" + text + "]", described(rule));
  }
  void points(std::string_view key, std::vector<Vec3>& values, const NumberRule& rule) override {
    std::string text;
    for (const Vec3& value : values) text += (text.empty() ? "" : ", ") + array(value);
    line(key, "[" + text + "]", described(rule));
  }
  // TOML wants a table's own keys before its sub-tables: sections are kept back until the table ends.
  void section(std::string_view key, std::string_view meaning,
               const std::function<void(ConfigVisitor&)>& body) override {
    std::ostringstream text;
    const std::string path = path_ + std::string(key);
    text << "\n" << comment_line(meaning) << "[" << path << "]\n";
    finish(text, path, body);
  }
  void list(std::string_view key, std::string_view meaning, std::size_t count,
            const std::function<void(std::size_t)>& /*resize*/,
            const std::function<void(ConfigVisitor&, std::size_t)>& item) override {
    for (std::size_t i = 0; i < count; ++i) {
      std::ostringstream text;
      const std::string path = path_ + std::string(key);
      text << "\n" << comment_line(i == 0 ? meaning : "") << "[[" << path << "]]\n";
      finish(text, path, [&](ConfigVisitor& v) { item(v, i); });
    }
  }
  bool given(std::string_view) const override { return true; }
  void problem(std::string_view, std::string_view) override {}
  void shared_with_others() override {}

  const std::string& sections() const { return sections_; }

 private:
  void finish(std::ostringstream& text, const std::string& path,
              const std::function<void(ConfigVisitor&)>& body) {
    Writer nested(text, path + ".", with_comments_);
    body(nested);
    sections_ += text.str() + nested.sections();
  }
  void line(std::string_view key, const std::string& value, const std::string& comment) {
    out_ << key << " = " << value;
    if (with_comments_ && !comment.empty()) out_ << "  # " << comment;
    out_ << "\n";
  }
  std::string comment_line(std::string_view meaning) const {
    return with_comments_ && !meaning.empty() ? "# " + std::string(meaning) + "\n" : "";
  }
  static std::string array(const Vec3& v) {
    return "[" + exact(v.x()) + ", " + exact(v.y()) + ", " + exact(v.z()) + "]";
  }
  static std::string described(const NumberRule& rule) {
    std::ostringstream text;
    text << rule.meaning << " (" << rule.lowest << " to " << rule.highest << (rule.unit.empty() ? "" : " ")
         << rule.unit << ")";
    return text.str();
  }

  std::ostringstream& out_;
  std::string path_;
  bool with_comments_;
  std::string sections_;
};

}  // namespace

std::string to_toml(const std::function<void(ConfigVisitor&)>& body, bool with_comments) {
  std::ostringstream out;
  Writer writer(out, "", with_comments);
  body(writer);
  return out.str() + writer.sections();
}

}  // namespace halocline::bus
