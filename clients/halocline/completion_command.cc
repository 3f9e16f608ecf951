#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "clients/halocline/calc/calc.h"
#include "clients/halocline/commands.h"

namespace halocline::clients {
namespace {

std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* sub : command.get_subcommands(nullptr)) words.push_back(sub->get_name());
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  }
  return words;
}

// One case for each command: what may follow it.
void append_cases(const CLI::App& command, const std::string& path, std::string& text) {
  std::string words = fmt::format("{}", fmt::join(words_of(command), " "));
  if (command.get_name() == "calc") words += fmt::format(" {}", fmt::join(quantity_names(), " "));
  if (command.get_name() == "completion") words += " bash";
  text += "    '" + path + "') words='" + words + "' ;;\n";
  for (const CLI::App* sub : command.get_subcommands(nullptr)) {
    append_cases(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), text);
  }
}

// Every command with its own commands, as bash patterns.
void append_paths(const CLI::App& command, const std::string& path, std::string& patterns) {
  for (const CLI::App* sub : command.get_subcommands(nullptr)) {
    const std::string name = path.empty() ? sub->get_name() : path + " " + sub->get_name();
    patterns += (patterns.empty() ? "'" : "|'") + name + "'";
    append_paths(*sub, name, patterns);
  }
}

}  // namespace

std::string footer(const std::string& examples) { return "Example:\n" + examples + "\n\n" + kExitCodes; }

std::string bash_completion(const CLI::App& app) {
  std::string cases, paths;
  append_cases(app, "", cases);
  append_paths(app, "", paths);
  return R"sh(# bash completion of halocline: eval "$(halocline completion bash)"
_halocline() {
  local path='' words='' word i
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    case "${path:+$path }$word" in
      )sh" +
         paths + R"sh() path="${path:+$path }$word" ;;
    esac
  done
  case "$path" in
)sh" + cases +
         R"sh(  esac
  COMPREPLY=($(compgen -W "$words" -- "${COMP_WORDS[COMP_CWORD]}"))
  [[ -n $path && ${COMP_WORDS[COMP_CWORD]} != -* ]] &&
    COMPREPLY+=($(compgen -f -- "${COMP_WORDS[COMP_CWORD]}"))
  return 0
}
complete -o filenames -F _halocline halocline
)sh";
}

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("completion", "Print the completion of a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash")->required()->check(CLI::IsMember({"bash"}));
  command->footer(footer("  eval \"$(halocline completion bash)\""));
  command->callback([shell, &app, &exit_code] {
    std::cout << bash_completion(app);
    exit_code = kDone;
  });
}

}  // namespace halocline::clients
