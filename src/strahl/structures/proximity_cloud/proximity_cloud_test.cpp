#include <strahl/structures/proximity_cloud/proximity_cloud.h>
namespace strahl {}
