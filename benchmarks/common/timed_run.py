"""One run of mpm_run, with one thread per rank, and the time that it took."""

import os
import subprocess
import tempfile
import threading
import time

from common import results


def execute(file, folder, limit, options=(), ranks=1):
    """Exit code, standard error, processor seconds and seconds by the clock; killed after `limit` seconds. `options`
    follow -- on the command line."""
    launcher = ("mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)) if ranks > 1 else ()
    command = [*launcher, str(results.BIN / "mpm_run"), str(file), "--output-dir", str(folder),
               *(("--", *options) if options else ())]
    # Runs at the same time share no folder of Open MPI's: the first to end would take it from the others.
    with tempfile.TemporaryDirectory(prefix="mpm-mpi-", ignore_cleanup_errors=True) as mpi_files:
        environment = results.environment(OMP_NUM_THREADS="1", OMPI_MCA_ess_singleton_isolated="1",
                                          OMPI_MCA_orte_tmpdir_base=mpi_files)
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
                                   env=environment)
        guard = threading.Timer(limit, process.kill)
        guard.start()
        with process.stderr as stream:
            said = stream.read()
        _, status, usage = os.wait4(process.pid, 0)
        guard.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, said, usage.ru_utime + usage.ru_stime, time.perf_counter() - start
