"""The studies of the implicit benchmark. A new one is a module beside these and a line of this list."""

from studies import cantilever, column, conditioning, cylinder, foam, footing, frictional_footing, laws, locking, necking, notched, platen, relaxation, size, steps, stiff

STUDIES = {module.STUDY.name: module.STUDY
           for module in (column, platen, relaxation, cantilever, cylinder, footing, frictional_footing, necking, notched, foam, steps, stiff, locking, laws, size, conditioning)}
