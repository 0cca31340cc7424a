/* spice_of.c - a netlist as dalcs writes it for ngspice, flat and with near-ideal devices.
 *
 *     spice_of SETTING FILE SIGNAL ...     settings from 0 on
 *
 * Before the netlist there is a line for each signal: "* SIGNAL = COLUMN COLUMN", the columns of ngspice's raw
 * file whose difference it is, "-" for 0. */
#include "dalcs.h"

#include <stdio.h>
#include <stdlib.h>

/* ngspice's steps now and then get too small with one and not with the next. */
static const char *const setting[] = {"gmin=1e-9 itl4=200", "gmin=1e-9 itl4=200 cshunt=1e-13"};

enum { N_SETTINGS = sizeof setting / sizeof setting[0] };

int main(int argc, char **argv) {
    int k = argc < 3 ? -1 : atoi(argv[1]);
    if (k < 0 || k >= N_SETTINGS) {
        fprintf(stderr, "usage: spice_of SETTING FILE SIGNAL ...     SETTING: 0 to %d\n",
                N_SETTINGS - 1);
        return 2;
    }
    /* the drop of the exponential at 1 A is 0.01 25.86 mV ln(1e14) = 8 mV */
    const struct dalcs_spice_options options = {.diode = DALCS_SPICE_EXPONENTIAL,
                                                .emission = 0.01,
                                                .series = 1e-3,
                                                .on = 1e-3,
                                                .off = 1e9,
                                                .edge = 1e-9,
                                                .reltol = 1e-4,
                                                .method = "gear",
                                                .extra_options = setting[k]};
    struct dalcs_session *session = NULL;
    enum dalcs_status status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = dalcs_session_read_file(session, argv[2]);
    }
    for (int i = 3; i < argc && status == DALCS_OK; i++) {
        const char *plus = NULL, *minus = NULL;
        status = dalcs_session_spice_columns(session, argv[i], &plus, &minus);
        printf("* %s = %s %s\n", argv[i], plus != NULL ? plus : "-", minus != NULL ? minus : "-");
    }
    if (status == DALCS_OK) {
        status = dalcs_session_write_spice(session, &options, stdout);
    }
    for (size_t m = 0;
         status != DALCS_OK && session != NULL && m < dalcs_session_n_messages(session); m++) {
        fprintf(stderr, "%s\n", dalcs_session_message(session, m, NULL));
    }
    dalcs_session_destroy(session);
    return status == DALCS_OK ? 0 : 1;
}
