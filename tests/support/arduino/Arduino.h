// The part of Arduino's core that the sketch of a probe uses, for a compiler without a board. The
// test that includes a sketch defines the functions.
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { LOW = 0, HIGH = 1, OUTPUT = 1, LED_BUILTIN = 25 };

uint32_t micros();
void pinMode(int pin, int mode);
void digitalWrite(int pin, int level);
int analogRead(int pin);
void analogReadResolution(int bits);

class SerialPort {
 public:
  void begin(unsigned long baud);
  explicit operator bool() const;
  int available();
  int read();
  int availableForWrite();
  size_t write(uint8_t byte);
  size_t write(const uint8_t* bytes, size_t count);
  size_t print(const char* text);
  size_t print(double value, int digits);
  size_t println(double value, int digits);
};
extern SerialPort Serial;
