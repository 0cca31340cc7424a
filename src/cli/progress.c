/* progress.c - "42 %  4.2 ms of 10 ms  1.3 ms/s  840 events  5 s left", rewritten in place. Short runs never
 * show it. */
#include "progress.h"

#include "quantity.h"

#include <time.h>

#define FIRST_AFTER  0.5 /* s */
#define REDRAW_EVERY 0.2 /* s */

static double read_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void dalcs_progress_init(struct dalcs_progress *progress, FILE *stream) {
    double now = read_clock();
    *progress = (struct dalcs_progress){.stream = stream, .start = now, .last = now};
}

static void write_left(FILE *stream, double seconds) {
    long s = (long)(seconds + 0.5);
    if (s < 60) {
        fprintf(stream, "%ld s left", s);
    } else if (s < 3600) {
        fprintf(stream, "%ld min %02ld s left", s / 60, s % 60);
    } else {
        fprintf(stream, "%ld h %02ld min left", s / 3600, s / 60 % 60);
    }
}

void dalcs_progress_update(struct dalcs_progress *progress, double time, double stop,
                           size_t n_events) {
    if (!progress->stream || !(stop > 0.0)) {
        return;
    }
    double now = read_clock(), elapsed = now - progress->start;
    if (elapsed < FIRST_AFTER || now - progress->last < REDRAW_EVERY) {
        return;
    }
    progress->last = now;
    progress->shown = true;
    char done[DALCS_QUANTITY_SIZE], all[DALCS_QUANTITY_SIZE], speed[DALCS_QUANTITY_SIZE];
    double rate = time / elapsed;
    const char *unit = progress->counts ? "points" : "s";
    fprintf(progress->stream, "\r%3.0f %%  %s of %s  %s  ", 100.0 * time / stop,
            dalcs_quantity_write(done, time, unit, 3), dalcs_quantity_write(all, stop, unit, 3),
            dalcs_quantity_write(speed, rate, progress->counts ? "points/s" : "s/s", 3));
    if (n_events > 0) {
        fprintf(progress->stream, "%zu event%s  ", n_events, n_events == 1 ? "" : "s");
    }
    if (rate > 0.0) {
        write_left(progress->stream, (stop - time) / rate);
    }
    fputs("\033[K", progress->stream);
    fflush(progress->stream);
}

void dalcs_progress_finish(struct dalcs_progress *progress) {
    if (progress->stream && progress->shown) {
        fputs("\r\033[K", progress->stream);
        fflush(progress->stream);
    }
    *progress = (struct dalcs_progress){0};
}
