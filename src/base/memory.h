/* memory.h - checked allocation, growable arrays and an arena. */
#ifndef DALCS_MEMORY_H
#define DALCS_MEMORY_H

#include "status.h"

#include <stdarg.h>
#include <stddef.h>

/* n zeroed objects of `size` bytes; NULL when out of memory or when n * size overflows. n = 0 gives
 * a unique non-NULL pointer. Release with free(). */
void *dalcs_alloc(size_t n, size_t size);

/* n objects of `size` bytes, the next ones in a storage for many, which is aligned for any type; *used grows by
 * their bytes. Without storage (NULL) that is all: so many bytes it has to have. */
static inline void *dalcs_carve(void *storage, size_t *used, size_t n, size_t size) {
    const size_t align = _Alignof(max_align_t);
    void *at = storage != NULL ? (unsigned char *)storage + *used : NULL;
    *used += (n * size + align - 1) / align * align;
    return at;
}

/* The same as dalcs_grow where there is no room. */
enum dalcs_status dalcs_grow_now(void *array, size_t *capacity, size_t need,
                                 size_t size) DALCS_MUST_CHECK;

/* Makes room for at least `need` items in *array (item size `size`, present capacity *capacity).
 * Growth is geometric and new items are zeroed. On failure *array and *capacity are unchanged. */
static inline DALCS_MUST_CHECK enum dalcs_status dalcs_grow(void *array, size_t *capacity,
                                                            size_t need, size_t size) {
    return need <= *capacity ? DALCS_OK : dalcs_grow_now(array, capacity, need, size);
}

/* An arena: many small objects that die together. Zero-initialise; finish frees everything. */
struct dalcs_arena {
    struct dalcs_arena_block *head;
};

/* For an arena that is still empty and will hold about so many bytes: they will be in one block. */
enum dalcs_status dalcs_arena_reserve(struct dalcs_arena *arena, size_t bytes) DALCS_MUST_CHECK;

/* Zeroed, aligned for any type; NULL when out of memory. */
void *dalcs_arena_alloc(struct dalcs_arena *arena, size_t n, size_t size);

/* Room for a text of this length, its NUL in place; NULL when out of memory. */
char *dalcs_arena_text(struct dalcs_arena *arena, size_t length);

/* A NUL-terminated copy of text[0..length-1]; NULL when out of memory. */
char *dalcs_arena_copy(struct dalcs_arena *arena, const char *text, size_t length);

/* printf into the arena; NULL when out of memory. */
char *dalcs_arena_printf(struct dalcs_arena *arena, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
char *dalcs_arena_printf_list(struct dalcs_arena *arena, const char *format, va_list arguments)
    __attribute__((format(printf, 2, 0)));

void dalcs_arena_finish(struct dalcs_arena *arena);

#endif
