// Judges the library's results by CGAL and OpenMesh; see README.md in this folder.
//
//   judge cases|mutations|inputs|weights|fairing|report [--cases FOLDER] [--exceptions FILE] [--bounds FILE]
//         [--data FOLDER] [--only TEXT] [--output FOLDER]
//
// Exit status: 0 no objections, 1 objections, 2 bad usage.

#include "commands.h"

#include <cstdio>
#include <exception>
#include <functional>
#include <map>

int main(int argc, char** argv) {
    using judge::Arguments;
    static const std::map<std::string, std::function<bool(const Arguments&)>> commands{
        {"cases", judge::run_cases},
        {"mutations", judge::run_mutations},
        {"inputs", judge::run_inputs},
        {"report", judge::run_report},
#ifdef JUDGE_CGAL
        {"weights", judge::run_weights},
        {"fairing", judge::run_fairing},
#endif
    };
    Arguments arguments;
    const std::map<std::string, std::string*> options{{"--cases", &arguments.cases},
                                                      {"--exceptions", &arguments.exceptions},
                                                      {"--bounds", &arguments.bounds},
                                                      {"--data", &arguments.data},
                                                      {"--only", &arguments.only},
                                                      {"--output", &arguments.output}};
    const auto command = argc > 1 ? commands.find(argv[1]) : commands.end();
    bool is_understood = command != commands.end() && argc % 2 == 0;
    for (int i = 2; is_understood && i + 1 < argc; i += 2) {
        const auto option = options.find(argv[i]);
        is_understood = option != options.end();
        if (is_understood) *option->second = argv[i + 1];
    }
    if (!is_understood) {
        std::fprintf(stderr, "usage: judge COMMAND [--cases FOLDER] [--exceptions FILE] [--bounds FILE]"
                             " [--data FOLDER] [--only TEXT] [--output FOLDER]\ncommands:");
        for (const auto& [name, run] : commands) std::fprintf(stderr, " %s", name.c_str());
        std::fprintf(stderr, "\n");
        return 2;
    }
    try {
        return command->second(arguments) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "judge: %s\n", error.what());
        return 1;
    }
}
