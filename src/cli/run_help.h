/* run_help.h - the options that `dalcs run` and `dalcs steady` share, as text of their help. */
#ifndef DALCS_RUN_HELP_H
#define DALCS_RUN_HELP_H

#define DALCS_RUN_OPTIONS                                                                          \
    "  -o, --output FILE   write waveforms; the format is that of the name, .csv or .raw, and - "  \
    "is\n"                                                                                         \
    "                      CSV on the standard output (may be repeated; without it FILE's name\n"  \
    "                      with .raw, in the current folder)\n"                                    \
    "      --method auto|radau|lobatto|euler\n"                                                    \
    "                      how to integrate: radau is Radau IIA, lobatto Lobatto IIIC, euler\n"    \
    "                      implicit Euler with a fixed step; auto chooses for each part "          \
    "(default:\n"                                                                                  \
    "                      the netlist's, else auto)\n"                                            \
    "      --tol X         how far a waveform may be wrong, over its largest value; 1e-13 to "     \
    "0.1\n"                                                                                        \
    "                      (default: .options reltol, else 1e-6); small circuits do better\n"      \
    "      --stages 1|3|5|7|9\n"                                                                   \
    "                      stages of radau and, but for 1, lobatto (default: by size and\n"        \
    "                      tolerance)\n"                                                           \
    "      --step H        time step in s, SPICE suffixes allowed: 1u. The largest one with "      \
    "auto,\n"                                                                                      \
    "                      fixed with radau, lobatto and euler (default: from .tran)\n"            \
    "      --fill X|none   add rows where those of .tran are too far apart, until curves through " \
    "all\n"                                                                                        \
    "                      rows are as near to the waveform, over its largest value (default:\n"   \
    "                      .options fill, else the tolerance, but 1e-6 where that is smaller)\n"   \
    "      --curve cubics|lines\n"                                                                 \
    "                      which curves: cubics, and lines beside events (default), or lines\n"    \
    "      --compress X    leave out rows that straight lines between others give, up to X "       \
    "times\n"                                                                                      \
    "                      a signal's largest value\n"                                             \
    "      --at T[,T...]   print at exactly these times, 0,1m; may be repeated; or FILE: at "      \
    "those "                                                                                       \
    "in\n"                                                                                         \
    "                      it, one a line\n"                                                       \
    "      --set NAME=X    another value: of a parameter, an element or \"dmod(vfwd)\"; may be "   \
    "repeated\n"                                                                                   \
    "      --seed N        of random values (default: .options seed, else 1)\n"                    \
    "      --only K        of the runs of .step and .mc number K alone\n"                          \
    "      --measures FILE write the results of .meas as a table, .csv: a row for each step of\n"  \
    "                      .step, or one; with -o none no waveforms are written\n"                 \
    "      --shard K/N     with -o none: the steps of the K-th of N parts, K from 1 on\n"          \
    "      --resume        with -o none: go on with the table of a run that was ended\n"           \
    "      --jobs N        with -o none: steps that run at a time, and of .wcase (default: all\n"  \
    "                      processors)\n"                                                          \
    "      --report FILE   write what the run did as JSON\n"                                       \
    "      --plot FILE     draw the waveforms with gnuplot, .svg, .png or .pdf\n"                  \
    "      --dump FILE     where to leave a one-step problem that could not be solved (default:\n" \
    "                      beside the output, out.failed.dalcs for out.csv)\n"                     \
    "      --all-signals   print the measurements of all signals, not of the first 24\n"           \
    "      --audit HOW     check the waveform against the netlist's devices: sample (default;\n"   \
    "                      each segment at one instant, some closely), full or off\n"              \
    "      --energy        print where the energy came from and where it went\n"                   \
    "      --ascii         write raw files as text (default: .options filetype, else binary)\n"    \
    "      --dialect ngspice|ltspice|xyce\n"                                                       \
    "                      for which simulator the netlist was written (default: what it shows)\n" \
    "      --split-steps   in a raw file, make each step of .step a plot of its own\n"

/* Behind those that only one verb has. */
#define DALCS_LAST_OPTIONS                                                                         \
    "  -q, --quiet         print nothing but warnings and errors\n"                                \
    "  -h, --help          this text\n"

#endif
