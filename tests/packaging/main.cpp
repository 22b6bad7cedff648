// tests/packaging/main.cpp - the program every consumer of the package builds: it includes strahl
// by its installed path and fails where the library does not answer.
#include <iostream>

#include <strahl/base/error.h>

int main() {
  const strahl::Error error(strahl::ErrorCode::usage, "no such option", "grid", "density");
  std::cout << error.what() << '\n';
  return error.code() == strahl::ErrorCode::usage ? 0 : 1;
}
