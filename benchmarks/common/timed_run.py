"""One run of mpm_run, with one thread per rank, and the time that it took."""

import os
import subprocess
import threading
import time

from common import results


def execute(file, folder, limit, options=(), ranks=1):
    """Exit code, standard error, processor seconds and seconds by the clock; killed after `limit` seconds. `options`
    follow -- on the command line."""
    launcher = ("mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks)) if ranks > 1 else ()
    command = [*launcher, str(results.BIN / "mpm_run"), str(file), "--output-dir", str(folder),
               *(("--", *options) if options else ())]
    environment = results.environment(OMP_NUM_THREADS="1", OMPI_MCA_ess_singleton_isolated="1")
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
