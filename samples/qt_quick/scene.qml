// The foam with items below and above it.
import QtQuick
import Froth

Rectangle {
    gradient: Gradient {
        GradientStop { position: 0; color: "#203040" }
        GradientStop { position: 1; color: "#c0d0e0" }
    }

    Foam {
        id: foam
        anchors.fill: parent
        NumberAnimation on turn {
            id: turning
            running: false
            from: 0
            to: 360
            duration: 12000
        }
    }

    Rectangle {
        anchors { left: parent.left; bottom: parent.bottom; margins: 12 }
        width: 150
        height: 32
        color: "#a0101418"
        Text {
            anchors { left: parent.left; leftMargin: 8; verticalCenter: parent.verticalCenter }
            text: "Foam in Qt Quick"
            color: "white"
            font.pixelSize: 14
        }
    }

    Rectangle {
        anchors { right: parent.right; bottom: parent.bottom; margins: 12 }
        width: 64
        height: 32
        color: button.pressed ? "#806000" : "#c09000"
        Text {
            anchors.centerIn: parent
            text: "Turn"
            font.pixelSize: 14
        }
        MouseArea {
            id: button
            anchors.fill: parent
            onClicked: turning.restart()
        }
    }
}
