#include "apps/common/options.hpp"

#include <vector>

#include "apps/common/command_line.hpp"
#include "core/version.hpp"

namespace mpm::apps {

ParsedOptions parse_command_line(int argc, char** argv, bool speak) {
  // The manual's options have one dash and several letters, which CLI11 would read as single-letter flags.
  std::vector<std::string> words;
  ParsedOptions parsed;
  RunOptions& o = parsed.options;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    if (word == "--") {
      o.solver_options.assign(argv + i + 1, argv + argc);
      break;
    }
    for (const char* old : {"-h5pt", "-lsdyna", "-rt", "-nsteps"}) {
      if (word == old) word = "-" + word;
    }
    words.push_back(word);
  }

  CommandLine line("Material point method for extreme deformation.", "mpm_run");
  line.footer(
      "Options after -- go to PETSc, the solver of implicit steps: -- -ksp_type cg -pc_type gamg\n"
      "Exit codes: 0 done, 2 wrong input, 3 numerical failure, 4 stopped early (a restart file was written), "
      "5 file error (also: out of file descriptors), 6 out of memory or threads.\n"
      "Ctrl+C, SIGTERM and SIGUSR1 write a restart file and exit with code 4. Under mpirun use\n"
      "SIGUSR1, sent to mpirun, or --max-wall-time: after Ctrl+C or SIGTERM mpirun ends with exit code 1\n"
      "and kills its ranks within seconds, even if they have not finished the restart file.");
  line.version(std::string(core::version) + " (" + std::string(core::git_hash) + ")");
  line.required("job", o.job,
                "input file Job.xmp (the extension may be omitted) or restart file Job_<step>.pe");
  line.option("--output-dir", o.output_dir, "folder for all files", true);
  line.flag("--dry-run", o.dry_run,
            "read, check and discretise the input, report what the run needs, and exit");
  line.flag("--h5pt", o.to_h5part, "(-h5pt) convert a restart file to H5Part and exit");
  line.flag("--lsdyna", o.lsdyna, "(-lsdyna) also write the particles as LS-DYNA SPH data");
  line.option(
      "--rt", o.restart_input,
      "(-rt) restart with the Grid, Solution, Output, Deactive, loads and material parameters of this file");
  line.option("--nsteps", o.status_rows, "(-nsteps) stop after this many rows of the .sta file",
              Range::positive);
  line.option("--max-wall-time", o.max_wall_time,
              "seconds after which a restart file is written and the run stops", Range::positive);
  if (const std::optional<int> code = line.parse(words, speak))
    parsed.leave = *code == 0 ? done : input_error;
  return parsed;
}

}  // namespace mpm::apps
