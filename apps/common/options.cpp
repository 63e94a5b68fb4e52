#include "apps/common/options.hpp"

#include <iostream>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/version.hpp"

namespace mpm::apps {

namespace {

/// CLI11's own prints the largest double in full.
CLI::Validator more_than_zero() {
  const auto check = [](const std::string& word) {
    double number = 0;
    const bool good = CLI::detail::lexical_cast(word, number) && number > 0;
    return good ? std::string() : "'" + word + "' is not a number above 0";
  };
  return CLI::Validator(check, "NUMBER > 0");
}

}  // namespace

ParsedOptions parse_command_line(int argc, char** argv, bool speak) {
  // The manual's options have one dash and several letters, which CLI11 would read as letters.
  std::vector<std::string> words;
  for (int i = argc - 1; i > 0; --i) {
    std::string word = argv[i];
    for (const char* old : {"-h5pt", "-lsdyna", "-rt", "-nsteps"}) {
      if (word == old) word = "-" + word;
    }
    words.push_back(word);
  }

  ParsedOptions parsed;
  RunOptions& o = parsed.options;
  CLI::App app("Material point method for extreme deformation.", "mpm_run");
  app.footer(
      "Exit codes: 0 done, 2 wrong input, 3 numerical failure, 4 stopped early (a restart file is there), 5 "
      "file error (file descriptors that run out included), 6 out of memory or threads.\n"
      "Ctrl+C, SIGTERM and SIGUSR1 write a restart file and leave with exit code 4. Under mpirun take\n"
      "SIGUSR1, sent to mpirun, or --max-wall-time: after Ctrl+C or SIGTERM mpirun ends with exit code 1\n"
      "and kills its ranks within seconds, whether or not they have written a restart file.");
  app.set_version_flag("--version", std::string(core::version) + " (" + std::string(core::git_hash) + ")");
  app.add_option("job", o.job,
                 "input file Job.xmp (the ending may be left out) or restart file Job_<step>.pe")
      ->required();
  app.add_option("--output-dir", o.output_dir, "folder for all files")->capture_default_str();
  app.add_flag("--dry-run", o.dry_run, "read, check, discretise, report what the run needs, and leave");
  app.add_flag("--h5pt", o.to_h5part, "(-h5pt) convert a restart file to H5Part and leave");
  app.add_flag("--lsdyna", o.lsdyna, "(-lsdyna) write the particles as LS-DYNA SPH data too");
  app.add_option("--rt", o.restart_input,
                 "(-rt) restart with another Grid, Solution, Output, Deactive from this .xmp");
  app.add_option("--nsteps", o.status_rows, "(-nsteps) stop after so many rows of the .sta file")
      ->check(more_than_zero());
  app.add_option("--max-wall-time", o.max_wall_time,
                 "seconds after which a restart file is written and the run stops")
      ->check(more_than_zero());
  try {
    app.parse(words);
  } catch (const CLI::ParseError& e) {
    std::ostringstream out, err;
    const int code = app.exit(e, out, err);
    if (speak) {
      std::cout << out.str() << std::flush;
      std::cerr << err.str() << std::flush;
    }
    parsed.leave = code == 0 ? done : input_error;
  }
  return parsed;
}

}  // namespace mpm::apps
