// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "halocline/calc/calc.h"
#include "halocline/commands.h"

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

// Command with its parents' names ("log output"), and the words that may follow it, separated by spaces.
struct Place {
  std::string path;
  std::string words;
};

void append_places(const CLI::App& command, const std::string& path, std::vector<Place>& places) {
  std::string words = fmt::format("{}", fmt::join(words_of(command), " "));
  if (command.get_name() == "calc") words += fmt::format(" {}", fmt::join(quantity_names(), " "));
  if (command.get_name() == "completion") words += " bash fish zsh";
  places.push_back({path, words});
  for (const CLI::App* sub : command.get_subcommands(nullptr)) {
    append_places(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), places);
  }
}

std::string quoted_paths(const std::vector<Place>& places, const char* separator) {
  std::string text;
  for (const Place& place : places) {
    if (!place.path.empty()) text += (text.empty() ? "'" : std::string(separator) + "'") + place.path + "'";
  }
  return text;
}

// Returns `case` alternatives that set `candidates`, for bash and zsh.
std::string cases(const std::vector<Place>& places) {
  std::string text;
  for (const Place& place : places)
    text += fmt::format("    '{}') candidates='{}' ;;\n", place.path, place.words);
  return text;
}

std::string bash_completion(const std::vector<Place>& places) {
  return R"sh(# bash completion of halocline: eval "$(halocline completion bash)"
_halocline() {
  local place='' candidates='' word i
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    case "${place:+$place }$word" in
      )sh" +
         quoted_paths(places, "|") + R"sh() place="${place:+$place }$word" ;;
    esac
  done
  case "$place" in
)sh" + cases(places) +
         R"sh(  esac
  COMPREPLY=($(compgen -W "$candidates" -- "${COMP_WORDS[COMP_CWORD]}"))
  [[ -n $place && ${COMP_WORDS[COMP_CWORD]} != -* ]] &&
    COMPREPLY+=($(compgen -f -- "${COMP_WORDS[COMP_CWORD]}"))
  return 0
}
complete -o filenames -F _halocline halocline
)sh";
}

std::string zsh_completion(const std::vector<Place>& places) {
  return R"sh(#compdef halocline
# zsh completion of halocline: a file _halocline in a folder of $fpath, or source <(halocline completion zsh)
_halocline() {
  local place='' candidates='' word
  for word in "${(@)words[2,CURRENT-1]}"; do
    case "${place:+$place }$word" in
      )sh" +
         quoted_paths(places, "|") + R"sh() place="${place:+$place }$word" ;;
    esac
  done
  case "$place" in
)sh" + cases(places) +
         R"sh(  esac
  compadd -- ${=candidates}
  [[ -z $place || $PREFIX == -* ]] || _files
}
if [[ ${funcstack[1]} == _halocline ]]; then _halocline; else compdef _halocline halocline; fi
)sh";
}

std::string fish_completion(const std::vector<Place>& places) {
  std::string text = R"sh(# fish completion of halocline: halocline completion fish | source
function __halocline_words
  set -l place ''
  for word in (commandline -opc)[2..-1]
    set -l longer (string trim "$place $word")
    contains -- $longer )sh" +
                     quoted_paths(places, " ") + R"sh(; and set place $longer
  end
  switch "$place"
)sh";
  for (const Place& place : places)
    text += fmt::format("    case '{}'\n      string split ' ' '{}'\n", place.path, place.words);
  return text + R"sh(  end
end
complete -c halocline -n __fish_is_first_arg -f
complete -c halocline -a '(__halocline_words)'
)sh";
}

}  // namespace

std::string footer(const std::string& examples) { return "Examples:\n" + examples + "\n\n" + kExitCodes; }

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("completion", "Print the completion of a shell");
  auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "bash, fish or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "fish", "zsh"}));
  command->footer(footer("  eval \"$(halocline completion bash)\""));
  command->callback([shell, &app, &exit_code] {
    std::vector<Place> places;
    append_places(app, "", places);
    std::cout << (*shell == "bash"   ? bash_completion(places)
                  : *shell == "fish" ? fish_completion(places)
                                     : zsh_completion(places));
    exit_code = kDone;
  });
}

}  // namespace halocline::clients
