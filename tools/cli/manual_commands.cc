#include "tools/cli/manual_commands.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/suggest.h"
#include "tools/app/version.h"
#include "tools/cli/completion.h"
#include "tools/cli/help_topics.h"
#include "tools/cli/man_page.h"

namespace parallax::tools {
namespace {

using Names = std::vector<std::string>;

/// Reports that there is no such `word`, with the nearest existing one.
void report_no_such(const std::string& what, const std::string& word, const Names& known,
                    Invocation& invocation) {
  auto built = invocation.sink().error_about(
      codes::kUsage, "", fmt::format("there is no {} `{}`", what, base::printable(word)));
  if (const auto near = base::nearest_name(word, known)) {
    built.fix(fmt::format("replace `{}` with `{}`", base::printable(word), *near));
  }
  built.note("`parallax help` lists commands and topics, docs/README.md the pages for all else");
}

const OptionTable* command_named(const Program& program, const std::string& name) {
  for (const auto* command : shown_commands(program)) {
    if (command->name() == name) return command;
  }
  return nullptr;
}

/// The output of the program for these words and --help.
std::string help_for(const Program& program, Names words) {
  words.insert(words.begin(), program.table.name());
  words.emplace_back("--help");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  return parse_command_line(program, static_cast<int>(argv.size()), argv.data()).output;
}

int tell_text(const std::string& text, Invocation& invocation) {
  if (!invocation.options().json) {
    invocation.result(text);
    return 0;
  }
  const nlohmann::ordered_json document{{"status", "ok"}, {"text", text}};
  invocation.document(base::json_text(document) + "\n");
  return 0;
}

int tell_topic(const std::string& word, const Program& program, Invocation& invocation) {
  if (word.empty()) return tell_text(help_for(program, {}), invocation);
  if (command_named(program, word) != nullptr)
    return tell_text(help_for(program, {word}), invocation);
  Names known;
  for (const auto* command : shown_commands(program)) known.push_back(command->name());
  for (const auto& topic : help_topics()) {
    if (topic.name == word) {
      return tell_text(fmt::format("{}\n\n{}", topic.title, topic.text), invocation);
    }
    known.emplace_back(topic.name);
  }
  report_no_such("command or topic", word, known, invocation);
  return 0;
}

Command help_command(const Program& program, Names words) {
  auto word = std::make_shared<std::string>();
  OptionTable command("help", "Tell of a command, or of a topic that concerns all of them");
  std::string topics = "Topics:\n";
  for (const auto& topic : help_topics()) {
    topics += fmt::format("  {:<12}{}\n", topic.name, topic.title);
    words.emplace_back(topic.name);
  }
  topics.pop_back();
  command.footer("Examples:\n  parallax help run\n  parallax help exit-codes\n" + topics);
  command.option("topic", *word, "A command or a topic; without one, all commands")
      .offers(std::move(words));
  return {std::move(command), [word, &program](Invocation& invocation) {
            return tell_topic(*word, program, invocation);
          }};
}

const ManualEdition& edition() {
  static const ManualEdition made{kVersion, kVersionDate};
  return made;
}

/// The text on standard output, or in the file that was asked for.
int put(const std::string& text, const std::string& file, Invocation& invocation) {
  if (file.empty()) return tell_text(text, invocation);
  (void)base::write_output(file, text, invocation.files(), invocation.sink());
  return 0;
}

int write_pages(const std::string& folder, const Program& program, Invocation& invocation) {
  const auto write = [&](const std::string& name, const std::string& page) {
    const auto path = (std::filesystem::path(folder) / (name + ".1")).string();
    return static_cast<bool>(base::write_output(path, page, invocation.files(), invocation.sink()));
  };
  if (!write("parallax", program_page(program, edition()))) return 0;
  for (const auto* command : shown_commands(program)) {
    const auto page = command_page(program, *command, edition());
    if (!write("parallax-" + command->name(), page)) return 0;
  }
  return 0;
}

struct ManOptions {
  std::string command, folder;
};

int write_manual(const ManOptions& options, const Program& program, Invocation& invocation) {
  if (!options.folder.empty()) return write_pages(options.folder, program, invocation);
  if (options.command.empty()) return put(program_page(program, edition()), "", invocation);
  const auto* command = command_named(program, options.command);
  if (command != nullptr) return put(command_page(program, *command, edition()), "", invocation);
  Names known;
  for (const auto* one : shown_commands(program)) known.push_back(one->name());
  report_no_such("command", options.command, known, invocation);
  return 0;
}

Command man_command(const Program& program, Names words) {
  auto options = std::make_shared<ManOptions>();
  OptionTable command("man", "Print the manual page of the program or of a command, for `man`");
  command.footer(
      "Examples:\n"
      "  parallax man run | man -l -\n"
      "  parallax man --out man1        every page, as an installation has them");
  command.option("command", options->command, "Of this command; default: of the program")
      .offers(std::move(words));
  command.option("--out", options->folder, "Write every page into this folder, which is there")
      .folder();
  return {std::move(command), [options, &program](Invocation& invocation) {
            return write_manual(*options, program, invocation);
          }};
}

struct CompletionOptions {
  std::string shell, file;
};

Command completion_command(const Program& program) {
  auto options = std::make_shared<CompletionOptions>();
  OptionTable command("completion", "Print the script by which a shell completes command lines");
  command.footer(
      "Examples:\n"
      "  source <(parallax completion bash)             for this shell\n"
      "  parallax completion fish -o ~/.config/fish/completions/parallax.fish\n"
      "The Debian package and `cmake --install` put the scripts where shells look for them.");
  command.option("shell", options->shell, "bash, zsh or fish")
      .required()
      .check(OneOf{{"bash", "zsh", "fish"}});
  command.option("-o,--output", options->file, "File to write; default: standard output").file();
  return {std::move(command), [options, &program](Invocation& invocation) {
            const auto text = options->shell == "bash"  ? bash_completion(program)
                              : options->shell == "zsh" ? zsh_completion(program)
                                                        : fish_completion(program);
            return put(text, options->file, invocation);
          }};
}

}  // namespace

std::vector<Command> manual_commands(const Program& program, const std::vector<Command>& commands) {
  Names words{"help", "man", "completion"};
  for (const auto& command : commands) {
    if (!command.options.is_hidden()) words.push_back(command.options.name());
  }
  std::vector<Command> made;
  made.push_back(help_command(program, words));
  made.push_back(man_command(program, words));
  made.push_back(completion_command(program));
  return made;
}

}  // namespace parallax::tools
