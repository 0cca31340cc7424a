/* row_volume.c - how much the files of a run will hold, before it begins.
 *
 * The grid of .tran says how many rows there are at least; events and what is filled in come on top. */
#include "row_volume.h"

#include "quantity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

/* Bytes from which a note comes before the run: a machine of 8 GB that reads such a file, and copies it once or twice
 * on
 * the way, as NumPy and viewers do, is half full; a disk writes it in seconds. */
static const double MANY_BYTES = 1e9;

/* Of one value: in a raw file it has eight; as text it is two at least ("0,") and mostly eighteen. */
static const double BINARY = 8.0, LEAST_TEXT = 2.0, USUAL_TEXT = 18.0;

double dalcs_row_volume_count(const struct dalcs_arguments *arguments,
                              const struct dalcs_request *request, size_t n_at) {
    const bool is_euler = arguments->method.name != NULL
                              ? strcmp(arguments->method.name, "euler") == 0
                              : request->euler; /* its steps may be longer */
    if (n_at > 0) {
        return (double)n_at;
    }
    if (!request->transient || !(request->step > 0.0) || arguments->rows.compress > 0.0 ||
        request->compresses || arguments->envelope.is_asked || is_euler) {
        return 0.0;
    }
    return ceil((request->stop - request->start) / request->step) + 1.0; /* the last one at tstop */
}

/* Bytes left on the disk where a file will be; INFINITY: it is none of a disk. */
static double room_for(const char *path) {
    struct stat there;
    struct statvfs disk;
    const bool is_special = stat(path, &there) == 0 && !S_ISREG(there.st_mode);
    const char *slash = strrchr(path, '/');
    char *folder = slash != NULL ? strndup(path, (size_t)(slash + 1 - path)) : strdup(".");
    const bool known = !is_special && folder != NULL && statvfs(folder, &disk) == 0;
    free(folder);
    return known ? (double)disk.f_bavail * (double)disk.f_frsize : (double)INFINITY;
}

enum dalcs_status dalcs_row_volume_tell(const struct dalcs_cli *cli,
                                        const struct dalcs_outputs *outputs,
                                        const struct dalcs_plot *plot, double n_rows, bool quiet) {
    const double n_all = n_rows * (double)plot->n_steps;
    const double n_values = n_all * ((double)plot->n_signals + 1.0);
    for (size_t k = 0; k < outputs->n_tables; k++) {
        const struct dalcs_table *table = &outputs->table[k];
        const bool is_text = table->format != &dalcs_raw_format;
        const double least = n_values * (is_text ? LEAST_TEXT : BINARY);
        const double usual = n_values * (is_text ? USUAL_TEXT : BINARY);
        const double room =
            dalcs_is_standard_output(table->path) ? INFINITY : room_for(table->path);
        char bytes[DALCS_QUANTITY_SIZE], left[DALCS_QUANTITY_SIZE];
        if (least > room) {
            dalcs_cli_error(
                cli,
                "'%s' would have %.0f rows of %zu values, at least %s, and its disk has "
                "%s left: a larger first time on .tran makes fewer rows, and --at, "
                "--compress or -o none do without most",
                table->path, n_all, plot->n_signals + 1, dalcs_quantity_write(bytes, least, "B", 3),
                dalcs_quantity_write(left, room, "B", 3));
            return DALCS_E_IO;
        }
        if (usual > MANY_BYTES && !quiet) {
            fprintf(cli->err,
                    "dalcs: note: '%s' will have at least %.0f rows of %zu values, about %s: a "
                    "larger first time on .tran makes fewer, and --fill adds those between them "
                    "that waveforms need\n",
                    table->path, n_all, plot->n_signals + 1,
                    dalcs_quantity_write(bytes, usual, "B", 3));
        }
    }
    return DALCS_OK;
}
