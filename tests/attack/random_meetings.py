"""Random scenes of bodies that meet, by the hundred: every type of contact, rigid bodies, debris, conduction, loads.

Each runs on one, two and three ranks and from a restart file and has to leave the same bits, or to fail at the same step
with the same words. Scenes are numbered, and number and seed make a scene: `--only N --keep FOLDER` makes one again."""

import sys

import _attack  # first: it adds the folder of the next one to the path
import _meetings

if __name__ == "__main__":
    sys.exit(_attack.numbered("scene", _meetings.judge, 200, __doc__))
