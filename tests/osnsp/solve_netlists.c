/* solve_netlists.c - the one-step problems of netlists, with the engine's answers.
 *
 *     solve_netlists FOLDER < NETLISTS       each of them ends with a line .end
 *
 * For each system and each sigma of 0 and 1 the problem is written to FOLDER/N.dalcs, N = 0, 1, ..., and a line
 * 'N SYSTEM SIGMA STATUS RESIDUAL' to the output. Switches are open where their names begin with so, else closed. */
#include "residual.h"
#include "system_file.h"
#include "text_network.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_SIZE = 1 << 16 };

static void must_be(bool condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "solve_netlists: %s\n", what);
        exit(1);
    }
}

static void solve(const struct text_network *net, int system, double sigma, const char *folder,
                  int number) {
    const struct dalcs_system *s = &net->network.system[system];
    struct dalcs_osnsp_options options = usual_osnsp_options();
    struct dalcs_osnsp osnsp;
    double *u = calloc((size_t)(s->n_x + s->n_inputs) + 1, sizeof(*u));
    double *y = calloc((size_t)dalcs_system_n_columns(s) + 1, sizeof(*y));
    bool *closed = calloc((size_t)s->n_pairs + 1, sizeof(*closed));
    must_be(u != NULL && y != NULL && closed != NULL, "out of memory");
    must_be(dalcs_osnsp_setup(&osnsp, s, &options) == DALCS_OK, "setup failed");
    text_network_inputs(net, system, u);
    for (int d = 0; d < s->n_pairs; d++) {
        closed[d] =
            s->pair[d].kind == DALCS_PAIR_SWITCH && strncmp(s->pair[d].element, "so", 2) != 0;
        dalcs_osnsp_command(&osnsp, d, closed[d]);
    }
    enum dalcs_status status = dalcs_osnsp_solve(&osnsp, sigma, u, y);
    char path[4096];
    snprintf(path, sizeof(path), "%s/%d.dalcs", folder, number);
    const struct dalcs_system_step step = {sigma, u, osnsp.mode, "a test"};
    must_be(dalcs_system_file_write(path, s, &step) == DALCS_OK, "cannot write");
    printf("%d %d %g %d %g\n", number, system, sigma, (int)status,
           residual_of(s, sigma, u, closed, y));
    dalcs_osnsp_finish(&osnsp);
    free(u);
    free(y);
    free(closed);
}

int main(int argc, char **argv) {
    static char text[TEXT_SIZE];
    size_t length = 0;
    int number = 0;
    must_be(argc == 2, "usage: solve_netlists FOLDER < NETLISTS");
    while (fgets(text + length, (int)(TEXT_SIZE - length), stdin) != NULL) {
        bool ends = strcmp(text + length, ".end\n") == 0;
        length += strlen(text + length);
        must_be(length + 2 < TEXT_SIZE, "a netlist is too long");
        if (!ends) {
            continue;
        }
        struct text_network net;
        enum dalcs_status status = text_network_build(&net, text);
        must_be(status == DALCS_OK, net.diag.n > 0 ? net.diag.item[0].text : "no network");
        for (int k = 0; k < net.network.n_systems; k++) {
            for (int sigma = 0; sigma < 2; sigma++) {
                solve(&net, k, sigma, argv[1], number++);
            }
        }
        text_network_finish(&net);
        length = 0;
    }
    return 0;
}
