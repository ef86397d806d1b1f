/* A robot's program in C: built against the installed package alone. consumer DOMAIN; exit code 0: all held. */
#define _POSIX_C_SOURCE 199309L
#include <liloc/client.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "box_frames.h"

#define CHECK(held)                                                                                         \
  do {                                                                                                      \
    if (!(held)) {                                                                                          \
      fprintf(stderr, "line %d: not so: %s; last error: %s\n", __LINE__, #held, liloc_client_last_error()); \
      exit(1);                                                                                              \
    }                                                                                                       \
  } while (0)

typedef struct seen {
  int poses;
  liloc_pose first, last;
} seen;

static void on_pose(const liloc_pose_update* update, void* user) {
  seen* s = user;
  if (s->poses++ == 0) s->first = update->T_odom_sensor;
  s->last = update->T_odom_sensor;
}

static void check_misuse(const liloc_client_options* good) {
  static const uint16_t units[FRAME_WIDTH * FRAME_HEIGHT];
  liloc_client* client = NULL;
  liloc_pose_update update;
  CHECK(liloc_client_create(NULL, sizeof *good, &client) == LILOC_INVALID_ARGUMENT);
  CHECK(liloc_client_create(good, 8, &client) == LILOC_INVALID_ARGUMENT);
  CHECK(client == NULL && strstr(liloc_client_last_error(), "sizeof"));
  CHECK(liloc_client_create(good, sizeof *good, &client) == LILOC_OK);
  CHECK(liloc_client_push_depth(client, units, FRAME_WIDTH, FRAME_HEIGHT, 1) == LILOC_WRONG_STATE);
  CHECK(strstr(liloc_client_last_error(), "liloc_client_start"));
  CHECK(liloc_client_newest(client, &update, sizeof update) == LILOC_WRONG_STATE);
  CHECK(liloc_client_destroy(client) == LILOC_OK);
}

static void wait_for_frames(const liloc_client* client, uint64_t frames) {
  const struct timespec pause = {0, 5 * 1000 * 1000};
  liloc_stats stats = {0};
  for (int i = 0; i < 4000 && stats.frames < frames; ++i) {
    CHECK(liloc_client_stats(client, &stats, sizeof stats) == LILOC_OK);
    nanosleep(&pause, NULL);
  }
  CHECK(stats.frames == frames && stats.frames_dropped == 0);
}

int main(int argc, char** argv) {
  static uint16_t units[FRAME_WIDTH * FRAME_HEIGHT];
  seen s = {0};
  liloc_client* client = NULL;
  liloc_client_options options;
  liloc_pose_update update;
  CHECK(argc == 2);
  CHECK(liloc_client_options_init(&options, sizeof options) == LILOC_OK);
  options.id = "consumer-c";
  options.domain = atoi(argv[1]);
  options.queue_frames = FRAME_COUNT;
  options.camera = (liloc_camera){
      FRAME_WIDTH, FRAME_HEIGHT, FOCAL_PX, FOCAL_PX, (FRAME_WIDTH - 1) / 2.0, (FRAME_HEIGHT - 1) / 2.0, UNIT_M};
  check_misuse(&options);

  CHECK(liloc_client_create(&options, sizeof options, &client) == LILOC_OK);
  CHECK(liloc_client_on_pose(client, on_pose, &s) == LILOC_OK);
  CHECK(liloc_client_start(client) == LILOC_OK);
  CHECK(liloc_client_push_depth(client, units, 8, 8, 1) == LILOC_INVALID_ARGUMENT);
  for (int i = 0; i < FRAME_COUNT; ++i) {
    render_frame(i, units);
    CHECK(liloc_client_push_depth(client, units, FRAME_WIDTH, FRAME_HEIGHT, frame_stamp_ns(i)) == LILOC_OK);
  }
  wait_for_frames(client, FRAME_COUNT);
  CHECK(liloc_client_newest(client, &update, sizeof update) == LILOC_OK);
  CHECK(liloc_client_stop(client) == LILOC_OK);
  CHECK(liloc_client_push_depth(client, units, FRAME_WIDTH, FRAME_HEIGHT, INT64_MAX) == LILOC_WRONG_STATE);

  CHECK(s.poses == FRAME_COUNT);
  CHECK(update.stamp_ns == frame_stamp_ns(FRAME_COUNT - 1) && update.converged);
  CHECK(update.observed[0] > 0.9 && update.observed[5] > 0.9);
  CHECK(!update.has_map && !update.server_connected && update.state == LILOC_SEARCHING);
  CHECK(distance_m(update.T_odom_sensor.translation_m, s.last.translation_m) == 0);
  printf("liloc %s: walked %.4f m, turned %.4f rad\n", liloc_client_version(),
         distance_m(s.first.translation_m, s.last.translation_m),
         angle_rad(s.first.rotation_xyzw, s.last.rotation_xyzw));
  CHECK(fabs(distance_m(s.first.translation_m, s.last.translation_m) - walked_m()) < 0.03);
  CHECK(fabs(angle_rad(s.first.rotation_xyzw, s.last.rotation_xyzw) - turned_rad()) < 0.02);
  CHECK(liloc_client_destroy(client) == LILOC_OK);
  return 0;
}
