"""Plots of the benchmark tables."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOURS = {"MUSL": "#1f5fa8", "USF": "#c8502d", "USL": "#3a8f4d", "USAVG": "#7b4fa3"}
GREY = "0.45"
plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                     "axes.axisbelow": True, "grid.color": "0.92", "legend.frameon": False, "savefig.dpi": 150,
                     "figure.constrained_layout.use": True})


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)


def throughput(rows, path):
    """ns of a core per particle-step over the number of particles, with the floors of memory and arithmetic."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2))
    for scheme in dict.fromkeys(r["scheme"] for r in rows):
        mine = [r for r in rows if r["scheme"] == scheme]
        size, colour = [r["particles"] for r in mine], COLOURS.get(scheme)
        axes.plot(size, [r["best_ns"] for r in mine], "o-", color=colour, label=scheme)
        axes.plot(size, [r["floor_ns"] for r in mine], ":", color=colour)
        axes.plot(size, [r["share_flop"] * r["best_ns"] for r in mine], "--", color=colour, lw=0.8)
    axes.plot([], [], ":", color=GREY, label="floor: bytes moved at the memory's speed")
    axes.plot([], [], "--", color=GREY, lw=0.8, label="floor: operations at the core's peak")
    axes.set(xscale="log", xlabel="particles", ylabel="core time per particle-step, ns",
             title="A step of the Taylor bar")
    axes.set_ylim(bottom=0)
    axes.legend()
    save(figure, path)


def scaling(rows, path):
    """Efficiency over cores; strong on the left, weak on the right."""
    studies = [s for s in ("strong", "weak") if any(r["study"] == s for r in rows)]
    figure, panels = plt.subplots(1, len(studies), figsize=(3.6 * len(studies) + 0.4, 3.8), sharey=True,
                                  squeeze=False)
    styles = {"metis": ("#1f5fa8", "ranks, METIS"), "uniform": ("#c8502d", "ranks, boxes"),
              "": ("#3a8f4d", "threads")}
    for axes, study in zip(panels[0], studies):
        for partition, (colour, label) in styles.items():
            mine = [r for r in rows if r["study"] == study and r["partition"] == partition]
            if not mine:
                continue
            cores = [r["ranks"] * r["threads"] for r in mine]
            axes.plot(cores, [100 * r["efficiency"] for r in mine], "-", color=colour, label=label)
            if partition:
                axes.plot(cores, [100 * r["computing_efficiency"] for r in mine], ":", color=colour, lw=1)
            for r, n in zip(mine, cores):  # hollow: not wall time
                face = "white" if r["oversubscribed"] else colour
                axes.plot(n, 100 * r["efficiency"], "o", color=colour, markerfacecolor=face)
        mine = [r for r in rows if r["study"] == "copies"]
        if mine:
            axes.plot([r["ranks"] for r in mine], [100 * r["efficiency"] for r in mine], "--", color=GREY, lw=1.2,
                      label="separate programs")
        ticks = sorted({r["ranks"] * r["threads"] for r in rows})
        axes.set_xscale("log", base=2)
        axes.set_xticks(ticks, [f"{t:.0f}" for t in ticks])
        axes.axhline(100, color=GREY, lw=0.8)
        axes.set(xlabel="cores", title=f"{study} scaling")
    panels[0][0].set(ylabel="parallel efficiency, %", ylim=(0, 115))
    panels[0][0].legend(loc="lower left")
    words = "dotted: computing alone"
    if any(r["oversubscribed"] for r in rows):
        words += "; hollow: more threads than cores, processor time without waiting"
    figure.supxlabel(words, fontsize=8, color=GREY)
    save(figure, path)


def costs(rows, path, title):
    """Bars of added ns with their standard errors, and the added bytes as text."""
    figure, axes = plt.subplots(figsize=(6.8, 1.0 + 0.23 * len(rows)))
    families = list(dict.fromkeys(r["family"] for r in rows))
    palette = plt.get_cmap("tab10")
    places = range(len(rows), 0, -1)
    axes.barh(places, [r["added_ns"] for r in rows], xerr=[r["error_ns"] for r in rows], height=0.7,
              color=[palette(families.index(r["family"]) % 10) for r in rows], ecolor=GREY, error_kw={"lw": 0.9})
    axes.set_yticks(places, [f"{r['feature']}  (against {r['against']})" for r in rows], fontsize=7)
    right = max(r["added_ns"] + r["error_ns"] for r in rows)
    for place, r in zip(places, rows):
        if r["added_state_bytes"]:
            end = max(0, r["added_ns"] + r["error_ns"])
            axes.annotate(f"{r['added_state_bytes']:+.0f} B", (end, place), xytext=(3, 0),
                          textcoords="offset points", va="center", fontsize=7, color=GREY)
    axes.axvline(0, color=GREY, lw=0.8)
    axes.grid(axis="y", visible=False)
    axes.set(xlabel="added ns per particle-step; added bytes beside the bar", title=title,
             ylim=(0.2, len(rows) + 0.8), xlim=(None, 1.12 * right))
    save(figure, path)
