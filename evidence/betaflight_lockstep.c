/* Lock-step for Betaflight's SITL, preloaded into the unchanged program (LD_PRELOAD).
 *
 * As it is, SITL runs by the clock of the machine, scaled by the rate at which the time stamps of states arrive, and two
 * threads receive while a third one computes: no two flights are the same. With this library
 * - its main thread sees a time that only reading it and sleeping advance, and that stops at the time stamp of the last
 *   state; the same states give the same motors, however fast they come;
 * - states and sticks are received only while the main thread waits for them;
 * - its ports are moved by BETAFLIGHT_PORTS, so that several run on one machine.
 * With BETAFLIGHT_LOCKSTEP=0 only ports are moved.
 *
 * SITL's packets are told apart by their ports: 9003 receives states, of which the first 8 bytes are the time [s], and
 * 9004 sticks.
 */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { FIRST_UDP = 9001, STATE = 9003, STICKS = 9004, FIRST_TCP = 5761, LAST_TCP = 5768 };
static const int64_t START = 5000000000; /* ns, until which it starts up without states */
static const int64_t READING = 1000;     /* ns, that reading the time takes */

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int64_t now;              /* ns, of the main thread, which alone advances it */
static int64_t granted = START;  /* ns, up to which the main thread may run */
static int64_t stamp = START;    /* ns, of the last state */
static int idle, sticks_waiting; /* the main thread waits for a state; the other one for sticks */
static int state_socket = -1, sticks_socket = -1;
static __thread int main_thread = -1;

#define REAL(name) static __typeof__(&name) real; if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

static int in_lockstep(void)
{
    static int chosen = -1;
    if (chosen < 0) {
        const char *given = getenv("BETAFLIGHT_LOCKSTEP");
        chosen = !given || strcmp(given, "0") != 0;
    }
    return chosen;
}

static int is_main(void)
{
    if (main_thread < 0)
        main_thread = gettid() == getpid();
    return main_thread;
}

static void advance(int64_t duration)
{
    now += duration;
    if (now < __atomic_load_n(&granted, __ATOMIC_ACQUIRE))
        return;
    pthread_mutex_lock(&lock);
    idle = 1;
    pthread_cond_broadcast(&changed);
    while (now >= granted)
        pthread_cond_wait(&changed, &lock);
    idle = 0;
    pthread_mutex_unlock(&lock);
}

int clock_gettime(clockid_t clock, struct timespec *time)
{
    REAL(clock_gettime);
    if (clock != CLOCK_MONOTONIC || !in_lockstep())
        return real(clock, time);
    if (is_main())
        advance(READING);
    int64_t at = is_main() ? now : stamp;
    time->tv_sec = at / 1000000000;
    time->tv_nsec = at % 1000000000;
    return 0;
}

int nanosleep(const struct timespec *wanted, struct timespec *left)
{
    REAL(nanosleep);
    if (!is_main() || !in_lockstep())
        return real(wanted, left);
    advance(wanted->tv_sec * 1000000000 + wanted->tv_nsec);
    return 0;
}

static uint16_t moved(uint16_t port)
{
    const char *by = getenv("BETAFLIGHT_PORTS");
    int ours = (port >= FIRST_UDP && port <= STICKS) || (port >= FIRST_TCP && port <= LAST_TCP);
    return by && ours ? port + atoi(by) : port;
}

int bind(int fd, const struct sockaddr *address, socklen_t size)
{
    REAL(bind);
    struct sockaddr_storage to = {0};
    struct sockaddr_in *ip = (struct sockaddr_in *)&to; /* the port is at the same place for IPv6 */
    memcpy(&to, address, size);
    uint16_t port = ntohs(ip->sin_port);
    if (port == STATE)
        state_socket = fd;
    if (port == STICKS)
        sticks_socket = fd;
    ip->sin_port = htons(moved(port));
    return real(fd, (struct sockaddr *)&to, size);
}

ssize_t sendto(int fd, const void *data, size_t length, int flags, const struct sockaddr *address, socklen_t size)
{
    REAL(sendto);
    struct sockaddr_in to = *(const struct sockaddr_in *)address;
    to.sin_port = htons(moved(ntohs(to.sin_port)));
    return real(fd, data, length, flags, (struct sockaddr *)&to, size);
}

/* The threads of states and sticks call this when they have done what the last packet asked. */
int select(int count, fd_set *read, fd_set *write, fd_set *except, struct timeval *timeout)
{
    REAL(select);
    if (in_lockstep() && (count == state_socket + 1 || count == sticks_socket + 1)) {
        pthread_mutex_lock(&lock);
        if (count == state_socket + 1)
            __atomic_store_n(&granted, stamp, __ATOMIC_RELEASE);
        else
            sticks_waiting = 1;
        pthread_cond_broadcast(&changed);
        pthread_mutex_unlock(&lock);
    }
    return real(count, read, write, except, timeout);
}

ssize_t recvfrom(int fd, void *data, size_t size, int flags, struct sockaddr *from, socklen_t *length)
{
    REAL(recvfrom);
    if (!in_lockstep() || (fd != state_socket && fd != sticks_socket))
        return real(fd, data, size, flags, from, length);
    int waiting = 0;
    pthread_mutex_lock(&lock);
    while (!idle || now < granted)
        pthread_cond_wait(&changed, &lock);
    if (fd == sticks_socket)
        sticks_waiting = 0;
    else
        while (!sticks_waiting || (ioctl(sticks_socket, FIONREAD, &waiting) == 0 && waiting > 0))
            pthread_cond_wait(&changed, &lock); /* sticks that came before the state count */
    ssize_t got = real(fd, data, size, flags, from, length);
    if (fd == state_socket && got >= (ssize_t)sizeof(double)) {
        double time;
        memcpy(&time, data, sizeof time);
        stamp = START + (int64_t)(time * 1e9 + 0.5);
    }
    pthread_mutex_unlock(&lock);
    return got;
}
