// An ESP32 with an MPU-6050 as a sensor for Footfall: prints lines over USB, and sends the same over Wi-Fi when a network is set.
//
// Wiring: VCC to 3V3, GND to GND, SDA to GPIO 21, SCL to GPIO 22. Board "ESP32 Dev Module"; no library is needed beyond the core's own.

#include <WiFi.h>
#include <WiFiUdp.h>
#include <Wire.h>

// Leave the name empty to use USB alone. HOST is the computer with the game.
const char *WIFI_NAME = "";
const char *WIFI_PASSWORD = "";
const char *HOST = "192.168.1.10";
const uint16_t PORT = 6969;

const uint8_t MPU = 0x68;
const uint32_t PERIOD_US = 10000;  // 100 Hz

// ±8 g and ±1000 °/s: a foot that lands exceeds the ranges that the sensor starts with.
const float G_PER_COUNT = 8.0f / 32768.0f;
const float DPS_PER_COUNT = 1000.0f / 32768.0f;

WiFiUDP udp;
uint32_t nextUs = 0;
uint32_t lines = 0;

void writeRegister(uint8_t address, uint8_t value) {
  Wire.beginTransmission(MPU);
  Wire.write(address);
  Wire.write(value);
  Wire.endTransmission();
}

int16_t readNumber() {
  int16_t high = Wire.read();
  return (int16_t)((high << 8) | Wire.read());
}

void tell(const char *line) {
  Serial.println(line);
  if (WiFi.status() == WL_CONNECTED) {
    udp.beginPacket(HOST, PORT);
    udp.print(line);
    udp.endPacket();
  }
}

void setup() {
  Serial.begin(115200);
  Wire.begin();
  Wire.setClock(400000);
  writeRegister(0x6B, 0x01);  // awake, clock of the gyroscope
  writeRegister(0x1A, 0x03);  // low-pass at 44 Hz
  writeRegister(0x1B, 0x10);  // ±1000 °/s
  writeRegister(0x1C, 0x10);  // ±8 g
  if (WIFI_NAME[0] != '\0') {
    WiFi.mode(WIFI_STA);
    WiFi.setSleep(false);  // sleep would add a tenth of a second
    WiFi.begin(WIFI_NAME, WIFI_PASSWORD);
  }
  nextUs = micros();
}

void loop() {
  // The difference goes round with the clock.
  if ((int32_t)(micros() - nextUs) < 0) {
    return;
  }
  nextUs += PERIOD_US;
  // The names tell units; whoever begins to listen later learns them too.
  if (lines++ % 100 == 0) {
    tell("time_us,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps");
  }
  uint32_t now = micros();
  Wire.beginTransmission(MPU);
  Wire.write(0x3B);
  Wire.endTransmission(false);
  if (Wire.requestFrom(MPU, (uint8_t)14) != 14) {
    return;  // a loose wire: nothing is told, and the game says so
  }
  float values[6];
  for (int axis = 0; axis < 3; axis++) {
    values[axis] = readNumber() * G_PER_COUNT;
  }
  readNumber();  // temperature
  for (int axis = 3; axis < 6; axis++) {
    values[axis] = readNumber() * DPS_PER_COUNT;
  }
  char line[128];
  snprintf(line, sizeof line, "%lu,%.4f,%.4f,%.4f,%.3f,%.3f,%.3f", (unsigned long)now, values[0], values[1], values[2], values[3], values[4], values[5]);
  tell(line);
}
