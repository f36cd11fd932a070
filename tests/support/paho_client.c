/* What a vehicle's software does with Paho C: a will, a kept session, QoS 0 and 1, a second client with its name.
   paho_client PORT; ends with 0 if the broker did as the calls want. */
#include <MQTTClient.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int failed = 0;
static void check(int holds, const char* what) {
  printf("%s: %s\n", holds ? "ok" : "FAILED", what);
  failed |= !holds;
}

static int connect_as(MQTTClient client, int is_clean, int* present) {
  MQTTClient_connectOptions options = MQTTClient_connectOptions_initializer;
  MQTTClient_willOptions will = MQTTClient_willOptions_initializer;
  options.cleansession = is_clean;
  options.keepAliveInterval = 20;
  options.MQTTVersion = MQTTVERSION_3_1_1;
  will.topicName = "c/paho";
  will.message = "CONNECTIONBROKEN";
  will.qos = 1;
  will.retained = 1;
  options.will = &will;
  const int code = MQTTClient_connect(client, &options);
  if (present != NULL) *present = options.returned.sessionPresent;
  return code;
}

static int send_text(MQTTClient client, const char* topic, const char* text, int qos, int retained) {
  MQTTClient_deliveryToken token;
  if (MQTTClient_publish(client, topic, (int)strlen(text), text, qos, retained, &token) != MQTTCLIENT_SUCCESS)
    return -1;
  return MQTTClient_waitForCompletion(client, token, 5000);
}

/* What a client has received. Callbacks, because one of Paho's receive() calls takes an error of another client's
   socket for its own. */
struct inbox {
  pthread_mutex_t mutex;
  int count, read;
  struct {
    char text[64];
    int retained;
  } messages[16];
};

static int on_message(void* context, char* topic, int size, MQTTClient_message* message) {
  (void)size;
  struct inbox* inbox = context;
  pthread_mutex_lock(&inbox->mutex);
  if (inbox->count < 16 && message->payloadlen < 64) {
    memcpy(inbox->messages[inbox->count].text, message->payload, (size_t)message->payloadlen);
    inbox->messages[inbox->count++].retained = message->retained;
  }
  pthread_mutex_unlock(&inbox->mutex);
  MQTTClient_freeMessage(&message);
  MQTTClient_free(topic);
  return 1;
}

static void on_lost(void* context, char* cause) {
  (void)context;
  (void)cause;
}

static int receives(struct inbox* inbox, const char* text, int retained) {
  for (int waited_ms = 0; waited_ms < 5000; waited_ms += 10) {
    pthread_mutex_lock(&inbox->mutex);
    const int is_there = inbox->read < inbox->count;
    const int is_right = is_there && strcmp(inbox->messages[inbox->read].text, text) == 0 &&
                         inbox->messages[inbox->read].retained == retained;
    inbox->read += is_there;
    pthread_mutex_unlock(&inbox->mutex);
    if (is_there) return is_right;
    usleep(10000);
  }
  return 0;
}

int main(int count, char** words) {
  if (count != 2) return 2;
  char uri[64];
  snprintf(uri, sizeof uri, "tcp://127.0.0.1:%s", words[1]);
  MQTTClient agv, again, master;
  MQTTClient_create(&agv, uri, "paho", MQTTCLIENT_PERSISTENCE_NONE, NULL);
  MQTTClient_create(&again, uri, "paho", MQTTCLIENT_PERSISTENCE_NONE, NULL);
  MQTTClient_create(&master, uri, "pahoMaster", MQTTCLIENT_PERSISTENCE_NONE, NULL);
  static struct inbox of_agv = {PTHREAD_MUTEX_INITIALIZER}, of_master = {PTHREAD_MUTEX_INITIALIZER};
  MQTTClient_setCallbacks(agv, &of_agv, on_lost, on_message, NULL);
  MQTTClient_setCallbacks(again, &of_agv, on_lost, on_message, NULL);
  MQTTClient_setCallbacks(master, &of_master, on_lost, on_message, NULL);
  int present = -1;
  check(connect_as(agv, 0, &present) == 0 && present == 0, "a kept session begins");
  char* const filters[] = {"order", "v/+/state", "$SYS/#"};
  int qos[] = {1, 2, 0};
  const int granted = MQTTClient_subscribeMany(agv, 3, filters, qos);
  check(granted == 0 || granted == 1 || granted == MQTT_BAD_SUBSCRIBE, "three filters are answered");
  check(qos[0] == 1 && qos[1] == 1 && qos[2] == 0x80, "QoS 1, QoS 1 instead of 2, and $SYS refused");
  check(send_text(agv, "c/paho", "ONLINE", 1, 1) == 0, "QoS 1 is acknowledged");
  check(send_text(agv, "v/1/state", "s", 0, 0) == 0 && receives(&of_agv, "s", 0), "QoS 0 comes");
  MQTTClient_disconnect(agv, 1000);
  check(connect_as(master, 1, &present) == 0 && present == 0, "a clean session begins");
  check(MQTTClient_subscribe(master, "c/#", 1) == 0 && receives(&of_master, "ONLINE", 1), "the retained message comes");
  check(send_text(master, "order", "o1", 1, 0) == 0 && send_text(master, "order", "o2", 1, 0) == 0, "two orders");
  check(connect_as(agv, 0, &present) == 0 && present == 1, "the session is there");
  check(receives(&of_agv, "o1", 0) && receives(&of_agv, "o2", 0), "the orders come in order");
  check(MQTTClient_unsubscribe(agv, "v/+/state") == 0, "a filter goes");
  check(connect_as(again, 0, &present) == 0 && present == 1, "a second client takes the name over");
  check(receives(&of_master, "CONNECTIONBROKEN", 0), "the will of the first one comes");
  check(send_text(again, "c/paho", "", 0, 1) == 0 && receives(&of_master, "", 0), "the retained message is removed");
  MQTTClient_disconnect(again, 1000);
  MQTTClient_disconnect(master, 1000);
  MQTTClient_destroy(&agv);
  MQTTClient_destroy(&again);
  MQTTClient_destroy(&master);
  return failed;
}
