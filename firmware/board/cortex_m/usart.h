/* Two serial lines at 1 Mbaud, received by interrupt. Source: ST RM0090 rev 19, section 30. */
#ifndef ERP_FIRMWARE_USART_H
#define ERP_FIRMWARE_USART_H
#include <stdbool.h>
#include <stdint.h>

typedef enum { USART_HOST = 0, USART_ROBOT = 1 } usart_line; /* USART1: PA9, PA10; 2: PA2, PA3 */

void usart_open(usart_line line);

/* The next received byte; false if there is none. Bytes beyond a queue of 1023 are lost. */
bool usart_take(usart_line line, uint8_t* byte);

/* Queues all bytes to be sent, or none if there is no room. */
bool usart_send(usart_line line, const uint8_t* bytes, unsigned count);

/* Sleeps until the next interrupt; returns at once if a received byte is in a queue. */
void usart_rest(void);

/* Moves queued bytes to the transmitters; to be called continuously. */
void usart_pump(void);
#endif
