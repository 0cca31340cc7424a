/* memory.c - checked allocation, growable arrays and an arena.
 *
 * Every size is checked for overflow before it is multiplied, and every failure comes back as NULL
 * or DALCS_E_NOMEM with nothing changed. The arena is a list of blocks; small objects share one,
 * an object larger than a quarter of a block gets its own. */
#include "memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

struct dalcs_arena_block {
    struct dalcs_arena_block *next;
    size_t size; /* bytes in data */
    size_t used;
    bool is_zero; /* in whole; else each piece is cleared as it is taken */
    _Alignas(max_align_t) unsigned char data[];
};

/* Blocks double from the first size to the last, so that a small netlist stays small and a huge one
 * makes few calls to the allocator. */
enum { FIRST_BLOCK = 1024, LAST_BLOCK = 1 << 24 };

/* Blocks of so many bytes come from the system, zeroed; smaller ones from what was freed before. */
enum { NEW_BLOCK = 1 << 17 };

/* Bytes of the largest piece of memory that glibc keeps for its thread. */
enum { MOST_CACHED = 1032 };

/* A netlist of a million elements spends a quarter of its time on touching pages of 4 kB first. Where the
 * system has pages of 2 MB it is asked for them; where not, nothing happens. */
static void prefer_large_pages(void *memory, size_t bytes) {
#ifdef MADV_HUGEPAGE
    const uintptr_t page = (uintptr_t)1 << 21;
    if (bytes >= 4 * page) {
        const uintptr_t first = ((uintptr_t)memory + page - 1) / page * page;
        const uintptr_t last = ((uintptr_t)memory + bytes) / page * page;
        (void)madvise((unsigned char *)memory + (first - (uintptr_t)memory), last - first,
                      MADV_HUGEPAGE);
    }
#else
    (void)memory;
    (void)bytes;
#endif
}

/* What a thread has freed lately, malloc of glibc gives out again at once; its calloc (to 2.40) does not
 * look there. */
static void *take_cached(size_t bytes) {
    void *memory = malloc(bytes);
    __asm__("" : "+r"(memory)); /* else compilers make a calloc of the two */
    if (memory != NULL) {
        memset(memory, 0, bytes);
    }
    return memory;
}

void *dalcs_alloc(size_t n, size_t size) {
    if (n == 0 || size == 0) {
        return take_cached(1);
    }
    if (n > PTRDIFF_MAX / size) {
        return NULL;
    }
    return n * size <= MOST_CACHED ? take_cached(n * size) : calloc(n, size);
}

enum dalcs_status dalcs_grow_now(void *array, size_t *capacity, size_t need, size_t size) {
    size_t bigger = *capacity < 8 ? 16 : *capacity + *capacity / 2;
    if (bigger < need) {
        bigger = need;
    }
    if (bigger > PTRDIFF_MAX / size) {
        return DALCS_E_NOMEM;
    }
    /* The caller's pointer may have any object type; only its bytes are portable to read. */
    void *old;
    memcpy(&old, array, sizeof old);
    void *grown = realloc(old, bigger * size);
    if (grown == NULL) {
        return DALCS_E_NOMEM;
    }
    prefer_large_pages(grown, bigger * size);
    memset((unsigned char *)grown + *capacity * size, 0, (bigger - *capacity) * size);
    memcpy(array, &grown, sizeof grown);
    *capacity = bigger;
    return DALCS_OK;
}

static struct dalcs_arena_block *make_block(size_t size) {
    if (size > PTRDIFF_MAX - sizeof(struct dalcs_arena_block)) {
        return NULL;
    }
    const size_t bytes = sizeof(struct dalcs_arena_block) + size;
    const bool is_new = bytes >= NEW_BLOCK;
    struct dalcs_arena_block *block = is_new ? calloc(1, bytes) : malloc(bytes);
    if (block != NULL) {
        prefer_large_pages(block, bytes);
        *block = (struct dalcs_arena_block){.size = size, .is_zero = is_new};
    }
    return block;
}

enum dalcs_status dalcs_arena_reserve(struct dalcs_arena *arena, size_t bytes) {
    arena->head = make_block(bytes);
    return arena->head != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static void *piece(const struct dalcs_arena_block *block, size_t start, size_t bytes) {
    unsigned char *at = (unsigned char *)block->data + start;
    return block->is_zero ? at : memset(at, 0, bytes);
}

/* align: a power of 2. */
static void *take(struct dalcs_arena *arena, size_t bytes, size_t align) {
    struct dalcs_arena_block *head = arena->head;
    if (head != NULL) {
        const size_t start = (head->used + align - 1) & ~(align - 1);
        if (start <= head->size && bytes <= head->size - start) {
            head->used = start + bytes;
            return piece(head, start, bytes);
        }
    }
    size_t block_size = head == NULL ? FIRST_BLOCK : head->size * 2;
    block_size = block_size > LAST_BLOCK ? LAST_BLOCK : block_size;
    const bool own = bytes > block_size / 4;
    struct dalcs_arena_block *block = make_block(own ? bytes : block_size);
    if (block == NULL) {
        return NULL;
    }
    block->used = bytes;
    if (own && head != NULL) {
        /* Behind the head, whose free room stays in use. */
        block->next = head->next;
        head->next = block;
    } else {
        block->next = head;
        arena->head = block;
    }
    return piece(block, 0, bytes);
}

void *dalcs_arena_alloc(struct dalcs_arena *arena, size_t n, size_t size) {
    if (n != 0 && size > PTRDIFF_MAX / n) {
        return NULL;
    }
    const size_t bytes = n * size;
    return take(arena, bytes == 0 ? 1 : bytes, _Alignof(max_align_t));
}

char *dalcs_arena_text(struct dalcs_arena *arena, size_t length) {
    return length < PTRDIFF_MAX ? take(arena, length + 1, 1) : NULL;
}

char *dalcs_arena_copy(struct dalcs_arena *arena, const char *text, size_t length) {
    char *copy = dalcs_arena_text(arena, length);
    if (copy != NULL && length > 0) {
        memcpy(copy, text, length);
    }
    return copy;
}

char *dalcs_arena_printf_list(struct dalcs_arena *arena, const char *format, va_list arguments) {
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = length < 0 ? NULL : take(arena, (size_t)length + 1, 1);
    if (text != NULL) {
        vsnprintf(text, (size_t)length + 1, format, arguments);
    }
    return text;
}

char *dalcs_arena_printf(struct dalcs_arena *arena, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char *text = dalcs_arena_printf_list(arena, format, arguments);
    va_end(arguments);
    return text;
}

void dalcs_arena_finish(struct dalcs_arena *arena) {
    struct dalcs_arena_block *block = arena->head;
    while (block != NULL) {
        struct dalcs_arena_block *next = block->next;
        free(block);
        block = next;
    }
    arena->head = NULL;
}
