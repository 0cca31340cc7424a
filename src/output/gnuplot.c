/* gnuplot.c - runs gnuplot.
 *
 * The script comes to it on its standard input from an unnamed temporary file and the picture
 * leaves through its standard output: no file name and no shell is involved. */
#include "gnuplot.h"

#include <errno.h>
#include <spawn.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* The exit status of gnuplot, or -1 with errno when it could not be run. */
static int run(int input, int output, int errors) {
    char name[] = "gnuplot", no_startup_files[] = "-d", from_input[] = "-";
    char *const argument[] = {name, no_startup_files, from_input, NULL};
    posix_spawn_file_actions_t actions;
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0) {
        errno = error;
        return -1;
    }
    const int pair[3][2] = {{input, 0}, {output, 1}, {errors, 2}};
    for (int i = 0; i < 3 && error == 0; i++) {
        error = posix_spawn_file_actions_adddup2(&actions, pair[i][0], pair[i][1]);
    }
    pid_t child = 0;
    if (error == 0) {
        error = posix_spawnp(&child, name, &actions, NULL, argument, environ);
    }
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        errno = error;
        return -1;
    }
    int result = 0;
    while (waitpid(child, &result, 0) < 0) {
        if (errno != EINTR) {
            return -1;
        }
    }
    return WIFEXITED(result) ? WEXITSTATUS(result) : 1;
}

/* The last line that says something. */
static void explain(char message[DALCS_GNUPLOT_MESSAGE], FILE *errors) {
    char line[DALCS_GNUPLOT_MESSAGE - 32], last[sizeof line] = "no reason given";
    rewind(errors);
    while (fgets(line, sizeof line, errors)) {
        line[strcspn(line, "\n")] = '\0';
        if (line[strspn(line, " ^\t")] != '\0') {
            memcpy(last, line, sizeof last);
        }
    }
    snprintf(message, DALCS_GNUPLOT_MESSAGE, "gnuplot failed: %s", last);
}

enum dalcs_status dalcs_gnuplot_run(FILE *script, struct dalcs_atomic_file *file,
                                    char message[DALCS_GNUPLOT_MESSAGE]) {
    FILE *errors = tmpfile();
    enum dalcs_status status = DALCS_E_IO;
    if (!errors) {
        file->error = errno;
        return DALCS_E_IO;
    }
    if (fflush(script) != 0 || ferror(script) || fseek(script, 0, SEEK_SET) != 0) {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "cannot write a temporary file: %s",
                 strerror(errno));
        fclose(errors);
        return DALCS_E_IO;
    }
    int result = run(fileno(script), fileno(file->stream), fileno(errors));
    struct stat picture;
    if (result < 0 || result == 127) {
        bool missing = result == 127 || errno == ENOENT;
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "%s",
                 missing ? "gnuplot is not installed (on Debian: apt-get install gnuplot-nox)"
                         : strerror(errno));
    } else if (result != 0) {
        explain(message, errors);
    } else if (fstat(fileno(file->stream), &picture) != 0 || picture.st_size == 0) {
        snprintf(message, DALCS_GNUPLOT_MESSAGE, "gnuplot wrote nothing");
    } else {
        status = DALCS_OK;
    }
    fclose(errors);
    return status;
}

enum dalcs_status dalcs_gnuplot_draw(struct dalcs_figure *figure) {
    FILE *script = tmpfile();
    if (!script) {
        figure->file.error = errno;
        return DALCS_E_IO;
    }
    dalcs_gnuplot_write(script, figure);
    enum dalcs_status status = dalcs_gnuplot_run(script, &figure->file, figure->message);
    fclose(script);
    return status;
}
