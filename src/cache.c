// cache.c

#include "cache.h"

#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Sums are taken, and files read, in pieces that a cache of the processor
// holds.
enum { PIECE = 1 << 20 };

// The start of a file, in the byte order of the machine; the sum is that of the
// sums of the parts that follow.
typedef struct cache_head {
  char magic[8];
  cache_key key, sum;
  uint64_t bytes;
  char what[CACHE_WHAT];
} cache_head;

static const char CACHE_MAGIC[8] = {'F', 'a', 'c', 'e', 't', 'C', '0', '1'};

// Two sums over 64-bit words with different multipliers; a last word is
// filled up with zeros, and the length counts.  Source: the mixing step is
// that of Steele, Lea and Flood 2014.
void cache_key_add(cache_key *k, const void *data, size_t n) {
  const unsigned char *p = data;
  for (size_t i = 0; i < n; i += 8) {
    uint64_t word = 0;
    memcpy(&word, p + i, n - i < 8 ? n - i : 8);
    k->a = (k->a ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    k->a ^= k->a >> 29;
    k->b = (k->b + word) * UINT64_C(0xbf58476d1ce4e5b9);
    k->b ^= k->b >> 32;
  }
  k->a = (k->a ^ n) * UINT64_C(0x94d049bb133111eb);
  k->a ^= k->a >> 31;
}

bool cache_key_same(cache_key x, cache_key y) {
  return x.a == y.a && x.b == y.b;
}

// Bytes whose pieces are summed, and read before that where `to` is not NULL.
typedef struct piece_job {
  const unsigned char *data;
  unsigned char *to;  // data itself
  int fd;
  uint64_t at;  // in the file
  size_t bytes;
  cache_key *sums;  // one a piece
  bool *bad;
} piece_job;

static bool read_bytes(int fd, unsigned char *to, size_t n, uint64_t at) {
  while (n > 0) {
    ssize_t got = pread(fd, to, n, (off_t)at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    at += (uint64_t)got;
    n -= (size_t)got;
  }
  return true;
}

static void sum_piece(void *context, size_t item, int worker) {
  (void)worker;
  const piece_job *job = context;
  size_t from = item * PIECE;
  size_t n = job->bytes - from < PIECE ? job->bytes - from : PIECE;
  job->bad[item] = job->to != NULL &&
                   !read_bytes(job->fd, job->to + from, n, job->at + from);
  job->sums[item] = CACHE_KEY_START;
  if (!job->bad[item]) cache_key_add(&job->sums[item], job->data + from, n);
}

// The key of all pieces; false when one could not be read.
static bool sum_pieces(cache_key *out, piece_job *job, pool *threads) {
  arena mem = {0};
  size_t n = (job->bytes + PIECE - 1) / PIECE;
  job->sums = ARENA_NEW(&mem, cache_key, n);
  job->bad = ARENA_NEW(&mem, bool, n);
  pool_run(threads, n, sum_piece, job);
  bool ok = true;
  for (size_t i = 0; i < n; i++)
    ok = ok && !job->bad[i];
  *out = CACHE_KEY_START;
  cache_key_add(out, job->sums, n * sizeof *job->sums);
  arena_free(&mem);
  return ok;
}

cache_key cache_sum(const void *data, size_t n, pool *threads) {
  cache_key k;
  piece_job job = {.data = data, .bytes = n};
  sum_pieces(&k, &job, threads);
  return k;
}

char *cache_path(const char *kind, cache_key key, arena *mem) {
  const char *folder = cache_folder(mem);
  if (folder == NULL) return NULL;
  return arena_format(mem, "%s/%s-%016llx%016llx.bin", folder, kind,
                      (unsigned long long)key.a, (unsigned long long)key.b);
}

// The head of an open file, if the file is whole.
static bool read_head(cache_head *h, int fd) {
  struct stat st;
  if (fstat(fd, &st) != 0 || !S_ISREG(st.st_mode)) return false;
  if (!read_bytes(fd, (unsigned char *)h, sizeof *h, 0)) return false;
  return memcmp(h->magic, CACHE_MAGIC, sizeof h->magic) == 0 &&
         (uint64_t)st.st_size - sizeof *h == h->bytes;
}

bool cache_open(cache_file *f, const char *kind, cache_key key) {
  arena mem = {0};
  cache_head head;
  const char *path = cache_path(kind, key, &mem);
  *f = (cache_file){.fd = -1, .at = sizeof head, .sum = CACHE_KEY_START};
  // A pipe in its place would block an ordinary open for ever.
  if (path != NULL) f->fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  arena_free(&mem);
  if (f->fd < 0) return false;
  if (!read_head(&head, f->fd) || !cache_key_same(head.key, key)) {
    close(f->fd);
    return false;
  }
  f->left = head.bytes;
  f->want = head.sum;
  return true;
}

bool cache_take(cache_file *f, void *to, size_t n, pool *threads) {
  cache_key part;
  piece_job job = {.data = to, .to = to, .fd = f->fd, .at = f->at, .bytes = n};
  if (n > f->left || !sum_pieces(&part, &job, threads)) return false;
  cache_key_add(&f->sum, &part, sizeof part);
  f->at += n;
  f->left -= n;
  return true;
}

bool cache_close(cache_file *f) {
  bool ok = f->left == 0 && cache_key_same(f->sum, f->want);
  if (ok) (void)futimens(f->fd, NULL);
  close(f->fd);
  return ok;
}

void cache_remove(const char *kind, cache_key key) {
  arena mem = {0};
  const char *path = cache_path(kind, key, &mem);
  if (path != NULL) (void)unlink(path);
  arena_free(&mem);
}

// Head and parts, to a new file.
static void write_item(FILE *out, const cache_item *item, pool *threads) {
  cache_head head = {.key = item->key, .sum = CACHE_KEY_START};
  memcpy(head.magic, CACHE_MAGIC, sizeof head.magic);
  snprintf(head.what, sizeof head.what, "%s", item->what);
  for (int i = 0; i < item->count; i++) {
    const cache_part *p = &item->parts[i];
    cache_key part = cache_sum(p->at, p->bytes, threads);
    cache_key_add(&head.sum, &part, sizeof part);
    head.bytes += p->bytes;
  }
  fwrite(&head, sizeof head, 1, out);
  for (int i = 0; i < item->count; i++)
    fwrite(item->parts[i].at, 1, item->parts[i].bytes, out);
}

// Whether an item is small enough to be kept.
static bool fits(const cache_item *item, uint64_t most) {
  uint64_t bytes = sizeof(cache_head);
  for (int i = 0; i < item->count; i++)
    bytes += item->parts[i].bytes;
  return bytes <= most;
}

// A pipe, a device or a link in the place of a file would be written to.
static void clear_place(const char *path) {
  struct stat st;
  if (path == NULL || lstat(path, &st) != 0 || S_ISREG(st.st_mode)) return;
  (void)unlink(path);
}

void cache_save(const cache_item *item, uint64_t most, pool *threads) {
  arena mem = {0};
  error err;
  file_writer w;
  const char *path = cache_path(item->kind, item->key, &mem);
  clear_place(path);
  if (path != NULL && fits(item, most) && file_create(&w, path, &mem, &err)) {
    // What a crash of the system leaves of it, the sum finds out.
    w.passing = true;
    write_item(w.stream, item, threads);
    if (file_commit(&w, &err)) cache_prune(most);
  }
  arena_free(&mem);
}

void cache_what(char what[CACHE_WHAT], const cache_entry *e) {
  arena mem = {0};
  cache_head head = {.bytes = 0};
  const char *path = arena_format(&mem, "%s/%s", cache_folder(&mem), e->name);
  int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  bool ok = fd >= 0 && read_head(&head, fd);
  if (fd >= 0) close(fd);
  memcpy(what, head.what, CACHE_WHAT);
  if (!ok) what[0] = '\0';
  what[CACHE_WHAT - 1] = '\0';
  for (char *c = what; *c != '\0'; c++)
    if (*c < ' ' || *c > '~') *c = '?';
  arena_free(&mem);
}
