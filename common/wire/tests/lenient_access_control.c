/* The access control of a patched client: Cyclone's own, except that it lets this participant create whatever
 * it likes and match whomever it likes. What it proves to others stays as it is: they must do the refusing.
 * LILOC_REAL_ACCESS_CONTROL names Cyclone's library. */
#include <dds/security/dds_security_api.h>
#include <dlfcn.h>
#include <stdlib.h>

static void* real;

static DDS_Security_boolean any_writer_or_reader(dds_security_access_control* instance,
                                                 const DDS_Security_PermissionsHandle handle,
                                                 const DDS_Security_DomainId domain,
                                                 const DDS_Security_char* topic, const DDS_Security_Qos* qos,
                                                 const DDS_Security_PartitionQosPolicy* partition,
                                                 const DDS_Security_DataTags* tags,
                                                 DDS_Security_SecurityException* ex) {
  (void)instance, (void)handle, (void)domain, (void)topic, (void)qos, (void)partition, (void)tags, (void)ex;
  return 1;
}

static DDS_Security_boolean any_topic(dds_security_access_control* instance,
                                      const DDS_Security_PermissionsHandle handle,
                                      const DDS_Security_DomainId domain, const DDS_Security_char* topic,
                                      const DDS_Security_Qos* qos, DDS_Security_SecurityException* ex) {
  (void)instance, (void)handle, (void)domain, (void)topic, (void)qos, (void)ex;
  return 1;
}

static DDS_Security_boolean any_remote_writer(dds_security_access_control* instance,
                                              const DDS_Security_PermissionsHandle handle,
                                              const DDS_Security_DomainId domain,
                                              const DDS_Security_PublicationBuiltinTopicDataSecure* data,
                                              DDS_Security_SecurityException* ex) {
  (void)instance, (void)handle, (void)domain, (void)data, (void)ex;
  return 1;
}

static DDS_Security_boolean any_remote_reader(dds_security_access_control* instance,
                                              const DDS_Security_PermissionsHandle handle,
                                              const DDS_Security_DomainId domain,
                                              const DDS_Security_SubscriptionBuiltinTopicDataSecure* data,
                                              DDS_Security_boolean* relay_only,
                                              DDS_Security_SecurityException* ex) {
  (void)instance, (void)handle, (void)domain, (void)data, (void)ex;
  *relay_only = 0;
  return 1;
}

int init_access_control(const char* argument, void** context, struct ddsi_domaingv* gv);
int init_access_control(const char* argument, void** context, struct ddsi_domaingv* gv) {
  const char* path = getenv("LILOC_REAL_ACCESS_CONTROL");
  plugin_init init;
  dds_security_access_control* made;
  real = path ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
  if (!real) return -1;
  *(void**)&init = dlsym(real, "init_access_control");
  if (!init || init(argument, context, gv) != 0) return -1;
  made = *context;
  made->check_create_datawriter = any_writer_or_reader;
  made->check_create_datareader = any_writer_or_reader;
  made->check_create_topic = any_topic;
  made->check_remote_datawriter = any_remote_writer;
  made->check_remote_datareader = any_remote_reader;
  return 0;
}

int finalize_access_control(void* context);
int finalize_access_control(void* context) {
  plugin_finalize finalize;
  *(void**)&finalize = dlsym(real, "finalize_access_control");
  return finalize ? finalize(context) : -1;
}
