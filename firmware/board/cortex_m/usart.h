/* Two serial lines at 1 Mbaud, received by interrupt. Source: ST RM0090 rev 19, section 30. */
#ifndef ERP_FIRMWARE_USART_H
#define ERP_FIRMWARE_USART_H
#include <stdbool.h>
#include <stdint.h>

typedef enum { USART_HOST = 0, USART_ROBOT = 1 } usart_line; /* USART1: PA9, PA10; 2: PA2, PA3 */

void usart_open(usart_line line);

/* The next byte that was received; false: none. What comes while 1023 wait is lost. */
bool usart_take(usart_line line, uint8_t* byte);

/* Queues bytes to be sent, all or, while there is no room, none. */
bool usart_send(usart_line line, const uint8_t* bytes, unsigned count);

/* Sleeps until the next interrupt; not while a received byte waits to be taken. */
void usart_rest(void);

/* Moves queued bytes into the transmitters as far as they take them. To be called all the time. */
void usart_pump(void);
#endif
