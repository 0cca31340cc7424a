/* background.c - starts, halts and ends the thread. A halted one waits in the solver's progress call. */
#define _GNU_SOURCE /* pthread_timedjoin_np */
#include "background.h"

#include "memory.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static void tell(const struct ng_background *b, bool is_not_running) {
    ng_thread_state *state = b->tell;
    if (state != NULL) {
        state(is_not_running, b->id, b->user);
    }
}

static void change(struct ng_background *b, enum ng_state state) {
    b->state = state;
    pthread_cond_broadcast(&b->changed);
}

enum dalcs_status ng_background_open(struct ng_background *b) {
    if (pthread_mutex_init(&b->lock, NULL) != 0) {
        return DALCS_E_NOMEM;
    }
    if (pthread_cond_init(&b->changed, NULL) != 0) {
        pthread_mutex_destroy(&b->lock);
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

static void *run(void *argument) {
    struct ng_background *b = argument;
    tell(b, false);
    b->work(b->argument, b->command);
    pthread_mutex_lock(&b->lock);
    change(b, NG_IDLE);
    pthread_mutex_unlock(&b->lock);
    tell(b, true);
    return NULL;
}

bool ng_background_is_here(const struct ng_background *b) {
    return b->has_thread && pthread_equal(pthread_self(), b->thread) != 0;
}

static void join(struct ng_background *b) {
    if (b->has_thread && !ng_background_is_here(b)) {
        pthread_join(b->thread, NULL);
        b->has_thread = false;
        free(b->command);
        b->command = NULL;
    }
}

enum dalcs_status ng_background_start(struct ng_background *b,
                                      void (*work)(void *argument, const char *command),
                                      void *argument, const char *command) {
    join(b);
    if (b->has_thread) {
        return DALCS_E_OPTION; /* its own last callback starts another one */
    }
    b->work = work;
    b->argument = argument;
    b->command = dalcs_alloc(strlen(command) + 1, 1);
    if (b->command == NULL) {
        return DALCS_E_NOMEM;
    }
    strcpy(b->command, command);
    b->state = NG_RUNNING; /* before it begins: a query right after this call must see it */
    /* signals are for the program's own threads */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    b->has_thread = pthread_create(&b->thread, NULL, run, b) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!b->has_thread) {
        b->state = NG_IDLE;
        free(b->command);
        b->command = NULL;
        return DALCS_E_NOMEM;
    }
    return DALCS_OK;
}

static enum ng_state state_of(struct ng_background *b) {
    pthread_mutex_lock(&b->lock);
    const enum ng_state state = b->state;
    pthread_mutex_unlock(&b->lock);
    return state;
}

bool ng_background_is_running(struct ng_background *b) {
    const enum ng_state state = state_of(b);
    return state == NG_RUNNING || state == NG_HALTING || state == NG_CANCELLING;
}

bool ng_background_is_halted(struct ng_background *b) {
    return state_of(b) == NG_HALTED;
}

bool ng_background_halt(struct ng_background *b) {
    pthread_mutex_lock(&b->lock);
    bool halted = b->state == NG_RUNNING;
    if (halted) {
        change(b, NG_HALTING);
        while (b->state == NG_HALTING && !ng_background_is_here(b)) {
            pthread_cond_wait(&b->changed, &b->lock);
        }
        halted = b->state == NG_HALTED;
    }
    pthread_mutex_unlock(&b->lock);
    if (halted) {
        tell(b, true);
    }
    return halted;
}

bool ng_background_resume(struct ng_background *b) {
    const bool was_halted = ng_background_is_halted(b);
    if (was_halted) {
        tell(b, false);
        pthread_mutex_lock(&b->lock);
        change(b, NG_RUNNING);
        pthread_mutex_unlock(&b->lock);
    }
    return was_halted;
}

void ng_background_end(struct ng_background *b) {
    pthread_mutex_lock(&b->lock);
    if (b->state == NG_HALTED) {
        change(b, NG_CANCELLING);
    }
    pthread_mutex_unlock(&b->lock);
    join(b);
}

enum dalcs_status ng_background_pause(struct ng_background *b) {
    pthread_mutex_lock(&b->lock);
    if (b->state == NG_HALTING && ng_background_is_here(b)) {
        change(b, NG_HALTED);
    }
    while (b->state == NG_HALTED && ng_background_is_here(b)) {
        pthread_cond_wait(&b->changed, &b->lock);
    }
    const bool is_cancelled = b->state == NG_CANCELLING;
    pthread_mutex_unlock(&b->lock);
    return is_cancelled ? DALCS_E_CANCELLED : DALCS_OK;
}

/* Has the thread gone, soon? */
static bool join_soon(struct ng_background *b) {
    static const time_t soon =
        2; /* s; much longer than from one question of a solver to its next */
    struct timespec until;
    if (!b->has_thread) {
        return true;
    }
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_sec += soon;
    b->has_thread = pthread_timedjoin_np(b->thread, NULL, &until) != 0;
    return !b->has_thread;
}

bool ng_background_close(struct ng_background *b) {
    pthread_mutex_lock(&b->lock);
    if (b->state != NG_IDLE) {
        change(b, NG_CANCELLING);
    }
    pthread_mutex_unlock(&b->lock);
    if (ng_background_is_here(b) || !join_soon(b)) {
        return false;
    }
    free(b->command);
    b->command = NULL;
    pthread_mutex_destroy(&b->lock);
    pthread_cond_destroy(&b->changed);
    return true;
}
